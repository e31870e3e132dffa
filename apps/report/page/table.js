// Tables as the report carries them: named columns of numbers or of texts, the numbers as base64 of little-endian floats.
//
//     {name, rows, kept, columns: [{name, f64: base64} | {name, f32: base64} | {name, constant: v} | {name, texts: [...], codes: base64}]}
//
// `rows` is what the file held, `kept` what the report carries of it: whole rows, the extremes of every column in every interval among them.

function bytes(base64) {
  const text = atob(base64);
  const out = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) out[i] = text.charCodeAt(i);
  return out.buffer;
}

function numbers(column, kept) {
  if (column.f64 !== undefined) return new Float64Array(bytes(column.f64));
  if (column.f32 !== undefined) return new Float32Array(bytes(column.f32));
  return new Float64Array(kept).fill(column.constant === null ? NaN : column.constant);
}

export class Table {
  constructor(json) {
    this.name = json.name;
    this.rows = json.rows;
    this.kept = json.kept;
    this.names = json.columns.map((column) => column.name);
    this.columns = new Map(json.columns.map((column) => [column.name, column]));
    this.decoded = new Map();
  }

  has(name) {
    return this.columns.has(name);
  }

  isText(name) {
    return this.columns.get(name)?.texts !== undefined;
  }

  /// The values of a column of numbers; undefined where there is none of that name.
  numbers(name) {
    const column = this.columns.get(name);
    if (column === undefined || column.texts !== undefined) return undefined;
    if (!this.decoded.has(name)) this.decoded.set(name, numbers(column, this.kept));
    return this.decoded.get(name);
  }

  /// The distinct texts of a column and, for each row, which one it is.
  texts(name) {
    const column = this.columns.get(name);
    if (!this.decoded.has(name)) this.decoded.set(name, {texts: column.texts, codes: new Uint32Array(bytes(column.codes))});
    return this.decoded.get(name);
  }

  /// What stands in a cell, a number or a text.
  cell(name, row) {
    if (!this.isText(name)) return this.numbers(name)[row];
    const {texts, codes} = this.texts(name);
    return texts[codes[row]];
  }

  /// As comma-separated text; a number has the digits that its width carries.
  csv() {
    const quoted = (text) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
    const shown = (value) => (typeof value === "string" ? quoted(value) : Number.isFinite(value) ? String(value) : "");
    const readers = this.names.map((name) => {
      const single = this.columns.get(name).f32 !== undefined;
      return (row) => shown(single ? Number(this.cell(name, row).toPrecision(9)) : this.cell(name, row));
    });
    const lines = [this.names.map(quoted).join(",")];
    for (let row = 0; row < this.kept; ++row) lines.push(readers.map((read) => read(row)).join(","));
    return lines.join("\n") + "\n";
  }
}

/// The last row k with values[k] <= at, where the values never fall; 0 where there is none.
export function lastRowAt(values, at) {
  let low = 0, high = values.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (values[middle] <= at) low = middle;
    else high = middle - 1;
  }
  return low;
}
