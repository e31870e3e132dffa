// Numbers for people.

/// At most `digits` significant digits, in the shorter of the usual and the scientific notation.
export function number(value, digits = 5) {
  if (value === null || value === undefined || Number.isNaN(value)) return "–";
  if (!Number.isFinite(value)) return value > 0 ? "∞" : "−∞";
  if (value === 0) return "0";
  const magnitude = Math.abs(value);
  const text = magnitude >= 1e-3 && magnitude < 1e6 ? String(Number(value.toPrecision(digits)))
                                                    : value.toExponential(Math.max(0, digits - 3)).replace(/\.?0+e/, "e").replace("e+", "e");
  return text.replace("-", "−").replace("e-", "e−");
}

export function withUnit(value, unit, digits) {
  return number(value, digits) + (unit && unit !== "1" ? "\u202f" + unit : "");
}

const kSmall = [[0.1, "m", 1e3], [1e-4, "µ", 1e6], [1e-7, "n", 1e9]], kLeast = 1e-10, kLarge = 1e4;
const kTakesPrefix = /^(m|s|N|J|W|rad|N m|m\/s|rad\/s)$/, kTakesKilo = /^(N|J|W|N m)$/;

/// The unit with the prefix that suits values of this magnitude, and what they are multiplied by.
export function prefixed(unit, magnitude) {
  const plain = {unit, factor: 1};
  if (!kTakesPrefix.test(unit ?? "") || !(magnitude > kLeast)) return plain;
  if (magnitude >= kLarge && kTakesKilo.test(unit)) return {unit: "k" + unit, factor: 1e-3};
  const [, prefix, factor] = kSmall.findLast(([below]) => magnitude < below) ?? [];
  return prefix === undefined ? plain : {unit: prefix + unit, factor};
}

/// A value in the unit that suits it: 3 mm, 0.25 N.
export function scaled(value, unit, digits) {
  const {unit: shown, factor} = prefixed(unit, Math.abs(value));
  return withUnit(value * factor, shown, digits);
}

/// A duration in s, with a unit that suits it.
export function duration(seconds) {
  const magnitude = Math.abs(seconds);
  if (!Number.isFinite(seconds)) return "–";
  if (magnitude !== 0 && magnitude < 1e-6) return withUnit(seconds * 1e9, "ns", 3);
  if (magnitude !== 0 && magnitude < 1e-3) return withUnit(seconds * 1e6, "µs", 3);
  if (magnitude !== 0 && magnitude < 1) return withUnit(seconds * 1e3, "ms", 3);
  return withUnit(seconds, "s", 4);
}

export function clockTime(t, span) {
  const digits = Math.max(0, Math.min(6, 3 - Math.floor(Math.log10(span || 1))));
  return t.toFixed(digits) + "\u202fs";
}
