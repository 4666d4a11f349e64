// Numbers as text: three significant digits, a dash for what was not measured.
import { isNumber } from "./results";

export const kNone = "–";

function significant(value: number, digits: number): string {
    const size = Math.abs(value);
    if (size !== 0 && (size < 1e-4 || size >= 1e7)) return value.toExponential(digits - 1).replace("e+", "e");
    const decimals = size === 0 ? 0 : Math.max(0, digits - 1 - Math.floor(Math.log10(size)));
    const text = value.toFixed(Math.min(decimals, 10));
    return size >= 10000 ? Number(text).toLocaleString("en-GB") : text;
}

export function number(value: unknown, digits = 3): string {
    return isNumber(value) ? significant(value, digits) : kNone;
}

export function percent(value: unknown): string {
    return isNumber(value) ? (100 * value).toFixed(2) : kNone;
}

export function megabytes(value: unknown): string {
    return isNumber(value) ? significant(value / 1e6, 3) : kNone;
}

export function ratio(value: unknown): string {
    return isNumber(value) ? `${significant(value, 3)}×` : kNone;
}

export function seconds(value: unknown): string {
    if (!isNumber(value)) return kNone;
    if (value < 120) return `${significant(value, 3)} s`;
    return value < 7200 ? `${(value / 60).toFixed(0)} min` : `${(value / 3600).toFixed(1)} h`;
}

/** `1 point`, `2 points`. */
export function counted(count: number, what: string): string {
    return `${count} ${what}${count === 1 ? "" : "s"}`;
}

/** Anything that a setting can be. */
export function plain(value: unknown): string {
    if (value === null || value === undefined) return kNone;
    if (typeof value === "number") return Number.isInteger(value) ? String(value) : significant(value, 4);
    if (typeof value === "object") return JSON.stringify(value);
    return String(value);
}
