// A table of rows that sorts by a click on a heading; numbers stand to the right.
import {element} from "./element.js";
import {number} from "./format.js";

const kPage = 500;  // rows at once

/// columns: [[key, heading, format?], ...]; rows: objects. onPick(row) where a row can be chosen; best: keys whose least value is marked.
export function dataTable(columns, rows, {label, onPick, mark} = {}) {
  const body = element("tbody");
  let shown = kPage, sorted = [...rows], order = {key: undefined, way: 1};
  const isNumeric = (key) => rows.some((row) => typeof row[key] === "number") && rows.every((row) => typeof row[key] !== "string");

  const cell = (row, [key, , format]) => {
    const value = row[key];
    const text = value === undefined ? "" : format ? format(value, row) : typeof value === "number" ? number(value, 7) : String(value);
    return element("td", {class: [typeof value === "number" ? "number" : "", mark?.(row, key) ? "best" : ""].join(" ").trim() || undefined}, text);
  };
  const fill = () => {
    body.replaceChildren(...sorted.slice(0, shown).map((row) => {
      const line = element("tr", {}, ...columns.map((column) => cell(row, column)));
      if (onPick) {
        line.tabIndex = 0;
        line.classList.add("pick");
        line.addEventListener("click", () => onPick(row));
        line.addEventListener("keydown", (event) => event.key === "Enter" && onPick(row));
      }
      return line;
    }));
    more.hidden = shown >= sorted.length;
  };
  const more = element("button", {type: "button", onclick: () => {
    shown += kPage;
    fill();
  }}, "more rows");
  const heading = ([key, text]) => element("th", {scope: "col", class: isNumeric(key) ? "number" : undefined},
    element("button", {type: "button", onclick: (event) => {
      order = {key, way: order.key === key ? -order.way : 1};
      const rank = (value) => (value === undefined || Number.isNaN(value) ? Infinity : value);
      sorted = [...rows].sort((a, b) => order.way * (rank(a[key]) < rank(b[key]) ? -1 : rank(a[key]) > rank(b[key]) ? 1 : 0));
      for (const th of head.querySelectorAll("th")) th.removeAttribute("aria-sort");
      event.currentTarget.parentElement.setAttribute("aria-sort", order.way > 0 ? "ascending" : "descending");
      fill();
    }}, text));
  const head = element("thead", {}, element("tr", {}, ...columns.map(heading)));
  fill();
  return element("div", {class: "scroll", tabindex: "0", role: "region", "aria-label": label}, element("table", {}, head, body), more);
}
