// The energy audit: what the record's energy does beside the work that is accounted for.
//
//     audit(t) = energy(t) - energy(t0) - sum of all work columns        0 where every joule has a name; or the column energy_error
import {number} from "./format.js";

/// One line for the record's head; undefined where it has no energy.
export function auditNote(table, events) {
  const energy = table.numbers("energy");
  if (energy === undefined) return undefined;
  const works = table.names.filter((name) => name.startsWith("work_")).map((name) => table.numbers(name));
  const first = energy[0], last = energy[energy.length - 1];
  const text = `energy ${number(first, 5)} → ${number(last, 5)} J`;
  const audit = table.numbers("energy_error");
  if (audit) return `${text}, audit within ${number(audit.reduce((most, v) => Math.max(most, Math.abs(v)), 0), 2)} J`;
  if (works.length > 0) {
    let largest = 0;
    for (let k = 0; k < energy.length; ++k) {
      const work = works.reduce((sum, values) => sum + values[k] - values[0], 0);
      largest = Math.max(largest, Math.abs(energy[k] - first - work));
    }
    return `${text}, audit within ${number(largest, 2)} J`;
  }
  if (!events?.has("energy_before") || !events.has("energy_after")) return text;
  const before = events.numbers("energy_before"), after = events.numbers("energy_after");
  const lost = before.reduce((sum, value, k) => sum + value - after[k], 0);
  return `${text}, of which ${number(lost, 4)} J in collisions`;
}

