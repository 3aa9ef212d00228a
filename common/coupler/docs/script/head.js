// SPDX-License-Identifier: Apache-2.0
// Before the page is there: points.css hides the rows until page.js, or its failure, has decided which to show.
document.documentElement.classList.add("waiting");
document.addEventListener("DOMContentLoaded", () => document.documentElement.classList.remove("waiting"));
