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
