// SPDX-License-Identifier: Apache-2.0
// What ESLint finds fault with in the scripts of this tree: those of pages, and those that test the node.
"use strict";

const recommended = require("@eslint/js").configs.recommended.rules;

const readonly = (names) => Object.fromEntries(names.split(" ").map((name) => [name, "readonly"]));
const everywhere = readonly("console fetch performance setInterval clearInterval setTimeout clearTimeout TextDecoderStream URL");
const browser = readonly("Blob FormData Intl IntersectionObserver document location navigator window " +
  "addEventListener requestAnimationFrame AbortController AbortSignal sessionStorage matchMedia");
const node = readonly("Buffer __dirname module process require setImmediate");

const rules = {
  ...recommended,
  complexity: ["error", 20],
  eqeqeq: "error",
  "no-eval": "error",
  "no-implied-eval": "error",
  "no-new-func": "error",
  "no-shadow": "error",
  "no-use-before-define": ["error", { functions: false }],
  "no-var": "error",
  "prefer-const": "error",
  // The pages show texts of maps and devices, which nobody here wrote: they become text, never markup.
  "no-restricted-properties": ["error", ...["innerHTML", "outerHTML", "insertAdjacentHTML"].map(
    (property) => ({ property, message: "use textContent" }))],
};

module.exports = [
  { linterOptions: { reportUnusedDisableDirectives: "error" } },
  {
    files: ["host/**/*.js", "common/**/*.js"],
    languageOptions: { ecmaVersion: 2022, sourceType: "script", globals: { ...everywhere, ...browser } },
    rules,
  },
  {
    files: ["test/**/*.js", "test/**/*.cjs"],
    languageOptions: { ecmaVersion: 2022, sourceType: "commonjs", globals: { ...everywhere, ...node } },
    rules,
  },
];
