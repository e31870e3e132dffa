// Order statistics of a sample, as apps/statistics.hpp has them.

/// The finite ones, in order.
export function sorted(values) {
  return Float64Array.from(values).filter(Number.isFinite).sort();
}

/// The value below which a share of a sorted sample lies, nearest rank.
export function percentile(sample, share) {
  return sample[Math.min(sample.length - 1, Math.max(0, Math.ceil(share * sample.length) - 1))];
}
