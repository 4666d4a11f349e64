// Where a logarithmic axis has its marks.

/** Values from low to high that read well: powers of ten over many decades, 1-2-5 over some, even steps within one. Both positive. */
export function logTicks(low: number, high: number, most = 8): number[] {
    const decades = Math.log10(high / low);
    const steps = decades > 6 ? [1] : decades > 3 ? [1, 3] : [1, 2, 5];
    let ticks: number[] = [];
    if (decades > 0.9) {
        for (let exponent = Math.floor(Math.log10(low)); exponent <= Math.ceil(Math.log10(high)); ++exponent)
            for (const step of steps) ticks.push(step * 10 ** exponent);
        ticks = ticks.filter((tick) => tick >= low && tick <= high);
    }
    if (ticks.length < 3) ticks = evenTicks(low, high);
    const every = Math.ceil(ticks.length / most);
    return ticks.filter((_, index) => index % every === 0);
}

/** Even steps of 1, 2 or 5 times a power of ten. */
export function evenTicks(low: number, high: number): number[] {
    const raw = (high - low) / 7;
    const power = 10 ** Math.floor(Math.log10(raw));
    const step = [1, 2, 5, 10].map((factor) => factor * power).find((size) => size >= raw) as number;
    const ticks: number[] = [];
    for (let index = Math.ceil(low / step); index * step <= high; ++index) ticks.push(index * step);
    return ticks;
}

/** The range of some positive values, with room around it. */
export function paddedRange(values: number[]): [number, number] {
    if (values.length === 0) return [0.1, 10];
    let low = Infinity;
    let high = 0;
    for (const value of values) {
        low = Math.min(low, value);
        high = Math.max(high, value);
    }
    const room = high > low ? (high / low) ** 0.07 : 2;
    return [low / Math.max(room, 1.05), high * Math.max(room, 1.05)];
}
