// The exact interval of a success rate, 95 % [Clopper and Pearson 1934]; mpc/success_interval.hpp says more.
function logFactorials(n) {
  const sums = new Float64Array(n + 1);
  for (let i = 1; i <= n; ++i) sums[i] = sums[i - 1] + Math.log(i);
  return sums;
}

/// [lower, upper] of k successes in n.
export function successInterval(k, n, tail = 0.025) {
  const sums = logFactorials(n);
  const cumulative = (most, p) => {
    let sum = 0;
    for (let i = 0; i <= most; ++i) sum += Math.exp(sums[n] - sums[i] - sums[n - i] + i * Math.log(p) + (n - i) * Math.log1p(-p));
    return sum;
  };
  const where = (most, level) => {  // cumulative falls with p
    let below = 0, above = 1;
    for (let i = 0; i < 50; ++i) {
      const p = (below + above) / 2;
      if (cumulative(most, p) > level) below = p;
      else above = p;
    }
    return (below + above) / 2;
  };
  return [k === 0 ? 0 : where(k - 1, 1 - tail), k === n ? 1 : where(k, tail)];
}
