// The unit of a quantity that a record names without one, by the names that plants, estimators and verdicts use.

const kUnits = [
  [/^gap_acceleration/, "m/s^2"], [/^gap_rate/, "m/s"], [/^gap/, "m"], [/theta|angle|tilt/, "rad"], [/omega/, "rad/s"],
  [/speed|(^|_)v[xyz]?$/, "m/s"], [/force|touch_peak/, "N"], [/(^|_)(time|since)$/, "s"],
  [/(^|_)[xyz]$|depth|plane|rebound|offset|(^|_)tip$/, "m"],
];

/// As it is shown: m/s².
export function shownUnit(unit) {
  return unit.replace("^2", "²");
}

/// Empty where the name tells nothing.
export function unitOf(name) {
  return kUnits.find(([pattern]) => pattern.test(name))?.[1] ?? "";
}

/// The largest magnitude of some lists of numbers.
export function largestOf(lists) {
  let largest = 0;
  for (const values of lists) for (const v of values) largest = Math.max(largest, Math.abs(v) || 0);
  return largest;
}
