// SPDX-License-Identifier: Apache-2.0
// Searches and sorts the table of points. Without it the page shows everything, in the map's order.
(function () {
  "use strict";

  const MOST = 500; // rows on the screen at a time: browsers are slow with tables of thousands
  const table = document.getElementById("points");
  const body = table.tBodies[0];
  const form = document.getElementById("search");
  const query = document.getElementById("query");
  const found = document.getElementById("found");
  const compare = new Intl.Collator(undefined, { numeric: true, sensitivity: "base" }).compare;
  const digit = [0, 1, 3, 4]; // of Modicon addresses, by table

  const more = document.createElement("button");
  more.type = "button";
  more.id = "more";
  table.after(more);
  let all = false; // asked for all rows

  const SEARCHED = ["name", "space", "type", "units", "behind", "message"];
  let rows = Array.from(body.rows, (element, place) => ({
    element,
    place,
    id: element.id,
    table: Number(element.dataset.table),
    first: Number(element.dataset.first),
    last: Number(element.dataset.last),
    text: null,
  }));

  /** What of a row is searched. The texts of ten thousand are not read before somebody searches. */
  function words(row) {
    row.text ??= SEARCHED.map((key) => text(row.element, key)).join("\n").toLowerCase();
    return row.text;
  }

  /** What stands in a cell. */
  function text(element, key) {
    const cell = element.getElementsByClassName(key)[0];
    if (!cell) return "";
    return Array.from(cell.childNodes, (node) => node.textContent).join("\n");
  }

  function holds(row, address) {
    return row.first <= address && address <= row.last;
  }

  /** Zero-based, or in the five or six digits of Modicon. */
  function has_address(row, number) {
    if (holds(row, number)) return true;
    return [10000, 100000].some((size) => {
      const address = number - digit[row.table] * size - 1;
      return address >= 0 && address < Math.min(size - 1, 65536) && holds(row, address);
    });
  }

  /** A number is looked for as a whole one: 12 finds address 12 and t_12, not 112. Other words may be parts. */
  function test_of(word) {
    if (!/^\d+$/.test(word)) return (row) => words(row).includes(word);
    const whole = new RegExp("(?<![\\d.])" + word + "(?![\\d.])");
    const number = Number(word);
    const padded = word.length >= 5 && word[0] === "0"; // a coil in Modicon's notation
    return (row) => {
      if (padded) return row.table === 0 && holds(row, number - 1);
      return has_address(row, number) || whole.test(words(row).split("\n", 2).join("\n"));
    };
  }

  function show() {
    const tests = query.value.toLowerCase().split(/\s+/).filter(Boolean).map(test_of);
    const wanted = new FormData(form).get("table");
    if (wanted) tests.push((row) => row.table === Number(wanted));
    const target = decodeURIComponent(location.hash.slice(1));
    let matches = 0;
    for (const row of rows) {
      const fits = tests.every((test) => test(row));
      if (fits) matches += 1;
      const hidden = !fits;
      const later = fits && !all && matches > MOST && row.id !== target;
      if (row.element.hidden !== hidden) row.element.hidden = hidden;
      if (row.element.classList.contains("later") !== later) row.element.classList.toggle("later", later);
    }
    const total = rows.length;
    found.textContent = matches === total ? `${total} points` : `${matches} of ${total} points`;
    more.hidden = all || matches <= MOST;
    more.textContent = `Show all ${matches}`;
    table.classList.toggle("none", matches === 0);
  }

  const KEYS = {
    address: (row) => row.first,
    modicon: (row) => row.table * 65536 + row.first,
    space: (row) => row.table,
    source: (row) => Number(text(row.element, "source").slice(1)),
  };

  function sort(header, button) {
    const key = header.dataset.key;
    const up = header.getAttribute("aria-sort") !== "ascending";
    for (const other of table.tHead.rows[0].cells) other.removeAttribute("aria-sort");
    header.setAttribute("aria-sort", up ? "ascending" : "descending");
    const by = KEYS[key] || ((row) => text(row.element, key));
    const keyed = rows.map((row) => [by(row), row]);
    const order = (a, b) => {
      if (a === b) return 0;
      if (a === "" || b === "") return a === "" ? 1 : -1; // what has none comes last either way
      const less = typeof a === "number" ? a - b : compare(a, b);
      return up ? less : -less;
    };
    keyed.sort(([a, x], [b, y]) => order(a, b) || x.place - y.place);
    rows = keyed.map(([, row]) => row);
    body.append(...rows.map((row) => row.element));
    show();
    button.focus();
  }

  for (const header of table.tHead.rows[0].cells) {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = header.textContent;
    button.addEventListener("click", () => sort(header, button));
    header.replaceChildren(button);
  }

  /** A link to a point shows it, whatever is searched for. */
  function go() {
    const target = document.getElementById(decodeURIComponent(location.hash.slice(1)));
    if (!target || target.parentElement !== body) return;
    if (target.hidden) form.reset();
    show();
    target.scrollIntoView({ block: "center" });
  }

  form.addEventListener("input", show);
  form.addEventListener("submit", (event) => event.preventDefault());
  more.addEventListener("click", () => {
    all = true;
    show();
  });
  window.addEventListener("hashchange", go);
  // A second click on the same link changes no hash.
  document.addEventListener("click", (event) => {
    const link = event.target.closest("a");
    if (link && new URL(link.href?.baseVal ?? link.href, document.baseURI).hash === location.hash) go();
  });
  document.addEventListener("keydown", (event) => {
    const typing = event.target.matches("input");
    if (event.key === "/" && !typing && !event.ctrlKey && !event.metaKey && !event.altKey) {
      event.preventDefault();
      query.focus();
      query.select();
    } else if (event.key === "Escape" && event.target === query) {
      query.value = "";
      show();
    }
  });

  form.hidden = false;
  show();
  document.documentElement.classList.remove("waiting");
  go();
})();
