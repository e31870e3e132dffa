// Where scenery has a number it may name a column instead: a number, "x1", or {column: "u1", polynomial: [c0, c1, ...]} in ascending powers.

/// A function of a place in the table (row k, share f of the way to row k + 1) that gives the number.
export function bind(value, table) {
  if (typeof value === "number") return () => value;
  const column = typeof value === "string" ? value : value.column;
  const values = table.numbers(column);
  if (values === undefined) throw new Error(`the scenery names column '${column}', which ${table.name} does not have`);
  const at = (k, f) => (f > 0 ? values[k] + f * (values[k + 1] - values[k]) : values[k]);
  if (typeof value === "string" || value.polynomial === undefined) return at;
  const coefficients = [...value.polynomial].reverse();
  return (k, f) => {
    const u = at(k, f);
    return coefficients.reduce((sum, c) => sum * u + c, 0);  // Horner
  };
}

/// Three such functions; a missing coordinate is 0.
export function bindVector(values, table) {
  return [0, 1, 2].map((i) => bind(values?.[i] ?? 0, table));
}

/// A value in whose column's name a # stands for i.
export function numbered(value, i) {
  return typeof value === "string" ? value.replace("#", i) : value;
}
