// Tables: sorted by a click on the head of a column, and searched where they are long.
"use strict";
(function (page) {
  const SORTED = 4, SEARCHED = 16;  // rows from which on

  // The number that a cell begins with; thin spaces separate thousands.
  function value_of(cell) {
    const text = cell.textContent.trim(), number = parseFloat(text.replace(/[\u2009\u202f](?=\d)/g, ""));
    return { number: /^[-+]?[.\d]/.test(text) ? number : NaN, text };
  }
  function compare(a, b) {
    if (!Number.isNaN(a.number) && !Number.isNaN(b.number)) return a.number - b.number || a.text.localeCompare(b.text);
    if (Number.isNaN(a.number) !== Number.isNaN(b.number)) return Number.isNaN(a.number) ? 1 : -1;
    return a.text.localeCompare(b.text, undefined, { numeric: true });
  }
  function make_sorted(table, body, rows) {
    const heads = [...table.tHead.rows[0].cells];
    // A cell over several columns, as the reason why there is no number, stands for all of them.
    const cell_of = (row, column) => {
      let at = 0;
      for (const cell of row.cells) { at += cell.colSpan; if (column < at) return cell; }
      return row.cells[row.cells.length - 1];
    };
    heads.forEach((head, column) => {
      if (!head.textContent.trim()) return;
      const button = page.make("button", "sort", head.textContent);
      button.type = "button";
      head.replaceChildren(button);
      head.setAttribute("aria-sort", "none");
      button.addEventListener("click", () => {
        const down = head.getAttribute("aria-sort") === "ascending" ? -1 : 1;
        heads.forEach((other) => other.hasAttribute("aria-sort") && other.setAttribute("aria-sort", "none"));
        head.setAttribute("aria-sort", down > 0 ? "ascending" : "descending");
        const keyed = rows.filter((row) => !row.classList.contains("sum")).map((row) => [value_of(cell_of(row, column)), row]);
        keyed.sort((a, b) => down * compare(a[0], b[0]));
        body.append(...keyed.map(([, row]) => row), ...rows.filter((row) => row.classList.contains("sum")));
      });
    });
  }
  function make_searched(table, rows) {
    const label = page.make("label", "search", "search "), field = page.make("input"), count = page.make("output");
    field.type = "search";
    field.addEventListener("input", () => {
      const words = field.value.toLowerCase().split(/\s+/).filter(Boolean);
      let shown = 0;
      for (const row of rows) {
        row.hidden = !words.every((word) => row.textContent.toLowerCase().includes(word));
        if (!row.hidden) ++shown;
      }
      count.textContent = words.length ? shown + " of " + rows.length + " rows" : "";
    });
    label.append(field, count);
    (table.closest(".scroll") || table).before(label);
  }
  document.querySelectorAll("table").forEach((table) => {
    const body = table.tBodies[0], rows = body ? [...body.rows] : [];
    if (table.tHead && table.tHead.rows.length === 1 && rows.length >= SORTED) make_sorted(table, body, rows);
    if (table.tHead && rows.length >= SEARCHED) make_searched(table, rows);
  });
})(scintrayPage);
