// A trajectory: its animation beside its plots, its events, its energy audit, and what every column holds.
import {Animation} from "./animation.js";
import {Clock} from "./clock.js";
import {auditNote} from "./energy_audit.js";
import {element, download, whenSeen} from "./element.js";
import {clockTime, number} from "./format.js";
import {EstimateMap} from "./estimate_map.js";
import {plotGroups} from "./groups.js";
import {laneKey} from "./modes.js";
import {Plots} from "./plots.js";
import {dataTable} from "./data_table.js";
import {Table} from "./table.js";
import {fastPhases} from "./fast_phase.js";
import {makeTransport} from "./transport.js";

const kMode = ["free", "collision", "contact"];

function modeName(value) {
  return typeof value === "number" ? kMode[value] ?? String(value) : value;
}

/// [{t, text}] of the events' table.
function readEvents(table) {
  if (table === undefined) return [];
  return Array.from(table.numbers("t"), (t, k) => ({
    t, text: `${number(t, 7)} s: ${table.cell("contact", k)} ${modeName(table.cell("from", k))} → ${modeName(table.cell("to", k))}`,
  }));
}

/// Smallest, largest, mean and last value of every column.
function columnsTable(table) {
  const rows = table.names.map((name) => {
    if (table.isText(name)) {
      const {texts, codes} = table.texts(name);
      const counts = texts.map((text, i) => `${codes.reduce((n, code) => n + (code === i), 0)} ${text}`);
      return {name, min: counts.join(", ")};
    }
    const values = table.numbers(name);
    let low = Infinity, high = -Infinity, sum = 0;
    for (const v of values) {
      low = Math.min(low, v);
      high = Math.max(high, v);
      sum += v;
    }
    return {name, min: low, mean: sum / values.length, max: high, last: values[values.length - 1]};
  });
  return dataTable([["name", "column"], ["min", "least"], ["mean", "mean"], ["max", "most"], ["last", "last"]], rows, {label: "Columns of the record"});
}

export class Record {
  constructor(part, index) {
    this.table = new Table(part);
    this.scenery = part.scenery;
    this.hasPicture = part.scenery?.bodies?.length > 0;
    this.eventsTable = part.events && new Table(part.events);
    this.time = this.table.numbers("t");
    this.events = readEvents(this.eventsTable);
    this.clock = new Clock(this.time[0], this.time[this.time.length - 1], [...new Set(this.events.map((event) => event.t))]);
    this.plots = new Plots(this.table, "t", plotGroups(this.table, "t", this.scenery), this.clock, this.events);
    this.estimates = (this.scenery?.estimates ?? []).map((json) => new EstimateMap(json, this.table, this.time, this.clock));
    this.plots.node.prepend(...this.estimates.map((map) => map.node));
    this.title = this.scenery?.title ?? part.name;
    this.node = element("section", {class: "record", id: "part-" + index, "aria-label": this.title}, ...this.head(), this.body(), ...this.tables(part));
  }

  head() {
    const {kept, rows} = this.table;
    const thinned = kept === rows ? `${rows} rows` : `${kept} of ${rows} rows: the extremes of every column in every interval are among them`;
    const facts = [clockTime(this.clock.end - this.clock.start, this.clock.end - this.clock.start), thinned];
    for (const name of this.table.names) {
      if (this.table.isText(name) && this.table.texts(name).texts.length === 1) facts.push(`all ${this.table.texts(name).texts[0].replaceAll("_", " ")}`);
    }
    if (this.events.length > 0) facts.push(`${this.events.length} events`);
    const note = auditNote(this.table, this.eventsTable);
    const button = element("button", {type: "button", onclick: () => download(this.table.name, this.table.csv())}, "CSV");
    button.setAttribute("aria-label", "Download the record as CSV");
    return [element("h2", {}, this.title), element("p", {class: "facts"}, facts.join(" · "), note ? " · " + note : "", button)];
  }

  body() {
    const side = element("div", {class: "side"});
    if (this.hasPicture) {
      const frame = element("div", {class: "stage"});
      const keys = element("p", {class: "keys"});
      side.append(frame, keys);
      whenSeen(frame, () => this.animate(frame, keys));
    }
    side.append(makeTransport(this.clock, this.events));
    const modes = laneKey(this.plots.lanes);
    if (modes.length > 1) {
      side.append(element("p", {class: "keys"}, ...modes.map((mode) =>
          element("span", {class: "key"}, element("i", {style: `background: var(--${mode.color})`}), mode.text))));
    }
    return element("div", {class: this.hasPicture ? "body with-stage" : "body"}, side, this.plots.node);
  }

  animate(frame, keys) {
    try {
      this.animation = new Animation(this.scenery, this.table, this.time);
    } catch (error) {
      frame.append(element("p", {class: "absent", role: "note"}, `No animation: ${error.message}.`));
      return;
    }
    this.animation.mount(frame);
    keys.append(...this.animation.key());
    this.clock.listen(() => this.animation.show(this.clock.t));
  }

  tables(part) {
    const made = [];
    const folded = (title, make) => {
      const details = element("details", {}, element("summary", {}, title));
      details.addEventListener("toggle", () => details.children.length === 1 && details.append(make()), {once: true});
      made.push(details);
    };
    if (part.fast_phases) made.push(fastPhases(new Table(part.fast_phases)));
    if (this.eventsTable) folded(`Events (${this.eventsTable.rows})`, () => this.eventRows());
    folded(`Columns (${this.table.names.length})`, () => columnsTable(this.table));
    return made;
  }

  eventRows() {
    const {eventsTable: table} = this;
    const rows = Array.from({length: table.kept}, (_, k) => Object.fromEntries(table.names.map((name) => [name, table.cell(name, k)])));
    for (const row of rows) [row.from, row.to] = [modeName(row.from), modeName(row.to)];
    const csv = element("button", {type: "button", "aria-label": "Download the events as CSV", onclick: () => download(table.name, table.csv())}, "CSV");
    return element("div", {}, dataTable(table.names.map((name) => [name, name.replaceAll("_", " ")]), rows,
                                        {label: "Events", onPick: (row) => this.clock.go(row.t)}), csv);
  }
}
