// Which columns share a plot, and under which title and unit: what the scenery asks for first, the rest by the names that records use.

/// By name: a pattern, the title, the unit, and the rank from the top.
const kKinds = [
  [/^mode_/, "Modes", "", 0],
  [/^status$/, "Status", "", 0],
  [/^u\d+$|^u$|^u_/, "Inputs", "", 1],
  [/^tau\d+$/, "Torques", "N m", 1],
  [/^a\d+$/, "Arm angles", "rad", 2],
  [/^gap_/, "Gaps", "m", 3],
  [/^lambda_/, "Forces of contacts and joints", "N", 4],
  [/^(energy|kinetic|potential)$/, "Energy", "J", 5],
  [/^energy_error$/, "Energy audit", "J", 5],
  [/^work_/, "Work", "J", 6],
  [/^(z?[xyz])\d*$/, "Positions", "m", 7],
  [/^v[xyz]\d*$/, "Velocities", "m/s", 8],
  [/^q[wxyz]\d*$/, "Attitude", "", 9],
  [/^theta\d*$|^q\d+$/, "Angles", "rad", 9],
  [/^omega[xyz]?\d*$|^v\d+$/, "Angular velocities", "rad/s", 10],
  [/^F[xyz]$/, "Force", "N", 2],
  [/^M[xyz]$/, "Torque", "N m", 2],
  [/^F[xyz]_error$/, "Force error", "N", 20],
  [/^M[xyz]_error$/, "Torque error", "N m", 21],
  [/^objective$/, "Objective", "", 22],
  [/^(residual|kkt.*)$/, "KKT residual", "", 23],
  [/^(iterations|steps)$/, "Iterations", "", 24],
  [/^time_us$/, "Time of a row", "µs", 25],
];
export const kOther = 15;  // the rank of what no pattern knows; diagnostics come after

function kindOf(name) {
  return kKinds.find(([pattern]) => pattern.test(name));
}

const kMost = 12;  // series that one plot can still tell apart

/// Splits a crowded group by what the names begin with: x1.. apart from y1..
function split(group) {
  const stems = new Map();
  for (const name of group.columns) {
    const stem = name.replace(/\d+$/, "");
    stems.set(stem, [...(stems.get(stem) ?? []), name]);
  }
  if (group.columns.length <= kMost || stems.size === 1 || stems.size === group.columns.length) return [group];
  return [...stems].map(([stem, columns]) => ({...group, title: `${group.title}: ${stem}`, columns}));
}

/// [{title, unit, columns, limits, bands, foresights, rank, folded}], from the top; columns of constants are left out, they are in the table of columns.
export function plotGroups(table, timeName, scenery) {
  const groups = new Map(), taken = new Set([timeName]);
  (scenery?.plots ?? []).forEach((plot, i) => {
    const columns = plot.columns.filter((name) => table.has(name));
    columns.forEach((name) => taken.add(name));
    const {title, unit = "", limits, bands, foresights} = plot;
    const folded = columns.every((name) => table.columns.get(name).constant !== undefined);  // nothing to be seen
    if (columns.length > 0) groups.set("asked" + i, {title, unit, columns, limits, bands, foresights, rank: 1 + i / 100, folded});
  });
  const folded = groups.size > 0;  // who asks for plots has said what is to be seen first
  for (const name of table.names) {
    const {constant, texts} = table.columns.get(name);
    if (taken.has(name) || (constant !== undefined && !/^mode_/.test(name)) || texts?.length === 1) continue;
    const [, title, unit, rank] = kindOf(name) ?? [null, name.replace(/\d+$/, ""), "", kOther];
    if (table.isText(name) && rank > 0) continue;
    const key = title + rank;
    if (!groups.has(key)) groups.set(key, {title, unit, columns: [], rank, folded: folded && rank === kOther});
    groups.get(key).columns.push(name);
  }
  return [...groups.values()].sort((a, b) => a.rank - b.rank).flatMap((group) => (group.rank === 0 ? [group] : split(group)));
}
