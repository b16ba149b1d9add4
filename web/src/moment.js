// Values between samples.

/** The sample before a time and how far the time is on the way to the next one. */
export function locate(times, time) {
  const last = times.length - 1;
  if (last < 1 || time <= times[0]) return { before: 0, after: 0, share: 0 };
  if (time >= times[last]) return { before: last, after: last, share: 0 };
  let low = 0;
  let high = last;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= time) low = middle;
    else high = middle;
  }
  return { before: low, after: high, share: (time - times[low]) / (times[high] - times[low]) };
}

/** Row of `size` numbers at a moment, along a straight line. */
export function rowAt(values, size, { before, after, share }) {
  const row = new Array(size);
  for (let k = 0; k < size; k++) {
    const from = values[before * size + k];
    row[k] = from + share * (values[after * size + k] - from);
  }
  return row;
}
