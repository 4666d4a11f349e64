// Which images a scene has, and how one is turned into the pixels of a canvas and into the text of one pixel.
import { categorical, kNoProbe, kNotANumber, sequential, type Colour } from "./colour_maps";
import { number } from "./format";
import { methodName, titleOf } from "./methods";
import { halfValues, kNoNumber, loadImage, type ReportImage } from "./report_image";
import { imagesOf, points, type Point, type Scene } from "./results";

export interface Layer {
    key: string;
    label: string;
    colours: boolean; // radiance; else one number a pixel
}

export const kLayers: Layer[] = [
    { key: "beauty", label: "beauty", colours: true },
    { key: "glossy", label: "glossy", colours: true },
    { key: "diffuse", label: "diffuse", colours: true },
    { key: "probe", label: "which probe", colours: false },
    { key: "handoffs", label: "hand-offs", colours: false },
    { key: "reads", label: "reads", colours: false },
    { key: "unresolved", label: "unresolved", colours: false },
];

/** Something that can be shown: the images of a point, or the reference's. */
export interface Entry {
    label: string;
    point: Point | null; // null: the reference
    images: Record<string, string>;
}

export function referenceOf(scene: Scene): Entry {
    return { label: "reference", point: null, images: imagesOf(scene.reference) };
}

/** Ours, then the others, then the reference. */
export function entriesOf(scene: Scene): Entry[] {
    const pictured = points(scene).filter((point) => Object.keys(imagesOf(point)).length > 0);
    pictured.sort((a, b) => Number(b.method === "ours") - Number(a.method === "ours"));
    const several = (method: string): boolean => pictured.filter((point) => point.method === method).length > 1;
    const label = (point: Point): string => (several(point.method) ? titleOf(point) : methodName(point.method));
    const shown = pictured.map((point): Entry => ({ label: label(point), point, images: imagesOf(point) }));
    const truth = referenceOf(scene);
    return Object.keys(truth.images).length > 0 ? [...shown, truth] : shown;
}

export interface Loaded {
    label: string;
    entry: Entry;
    image: ReportImage | null; // null: `problem` says why
    reference: ReportImage | null; // set: the error against it is shown, not the image
    problem: string;
}

/** @param truth  set: the error against it is wanted, which colours of points have; everything else is shown as it is */
export async function load(entry: Entry, layer: Layer, truth: Entry | undefined): Promise<Loaded> {
    const against = layer.colours && entry.point ? truth : undefined;
    const label = against ? `error of ${entry.label}` : entry.label;
    const missing = (problem: string): Loaded => ({ label, entry, image: null, reference: null, problem });
    const file = entry.images[layer.key];
    if (!file) return missing(`${entry.point ? entry.label : "The reference"} has no image of ${layer.label}.`);
    try {
        const image = await loadImage(file);
        if (!against) return { label, entry, image, reference: null, problem: "" };
        const truthFile = against.images[layer.key];
        if (!truthFile) return missing(`The reference has no image of ${layer.label}, so there is no error.`);
        const reference = await loadImage(truthFile);
        if (reference.width !== image.width || reference.height !== image.height) return missing("Image and reference differ in size.");
        return { label, entry, image, reference, problem: "" };
    } catch (problem) {
        return missing(`Can't show ${file}: ${String(problem)}`);
    }
}

// Narkowicz 2015, "ACES Filmic Tone Mapping Curve", with its customary exposure of 0.6: as the command's PNG files.
function toneMapped(value: number): number {
    const x = 0.6 * Math.max(0, value);
    return Math.min(1, (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14));
}
function srgb(linear: number): number {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055; // IEC 61966-2-1
}

/** 8-bit sRGB of each half at an exposure. */
export function toneTable(exposure: number): Uint8ClampedArray {
    const table = new Uint8ClampedArray(65536);
    for (let bits = 0; bits < 65536; ++bits) {
        const value = halfValues[bits] as number;
        table[bits] = value === Infinity ? 255 : Math.round(255 * srgb(toneMapped(value * exposure)));
    }
    return table;
}

/** Scale that takes the log-average luminance to 0.18 (Reinhard et al. 2002); black pixels are left out, 1 for a black image. */
export function autoExposure(image: ReportImage): number {
    const halves = image.halves;
    if (!halves) return 1;
    let sum = 0;
    let count = 0;
    for (let i = 0; i < halves.length; i += 3) {
        const part = (channel: number): number => halfValues[halves[i + channel] as number] as number;
        const luminance = 0.2126 * part(0) + 0.7152 * part(1) + 0.0722 * part(2);
        if (!(luminance > 0) || luminance === Infinity) continue;
        sum += Math.log(luminance);
        ++count;
    }
    return count ? 0.18 / Math.exp(sum / count) : 1;
}

/** One exposure for all that are seen together: the reference's, else that of the first with colours. */
export function sharedExposure(reference: Loaded | null, others: Loaded[]): number {
    const base = reference?.image ?? others.find((one) => one.image?.halves)?.image;
    return base ? autoExposure(base) : 1;
}

/** Root of the relative squared error, (a - b)^2 / (b^2 + 0.01) averaged over the channels: relMSE before its mean over pixels. */
export function relativeError(image: ReportImage, reference: ReportImage, pixel: number): number {
    let sum = 0;
    for (let channel = 0; channel < 3; ++channel) {
        const a = halfValues[image.halves?.[3 * pixel + channel] ?? 0] as number;
        const b = halfValues[reference.halves?.[3 * pixel + channel] ?? 0] as number;
        sum += (a - b) ** 2 / (b * b + 0.01);
    }
    return Math.sqrt(sum / 3);
}

/** The largest number but for the highest 0.5 % of the pixels, at least 1: where the colours end. */
export function topOf(images: ReportImage[]): number {
    const values = new Uint32Array(images.reduce((sum, image) => sum + (image.numbers?.length ?? 0), 0));
    let count = 0;
    for (const image of images) for (const value of image.numbers ?? []) if (value !== kNoNumber) values[count++] = value;
    const present = values.subarray(0, count).sort();
    return Math.max(1, present[Math.floor(0.995 * (count - 1))] ?? 1);
}

export interface Paint {
    tones: Uint8ClampedArray; // toneTable
    top: number; // topOf
}

export function paint(loaded: Loaded, layer: Layer, how: Paint): HTMLCanvasElement | null {
    const { image, reference } = loaded;
    if (!image) return null;
    const canvas = document.createElement("canvas");
    canvas.width = image.width;
    canvas.height = image.height;
    const context = canvas.getContext("2d");
    if (!context || image.width * image.height === 0) return null;
    const pixels = context.createImageData(image.width, image.height);
    const data = pixels.data;
    const put = (pixel: number, colour: Colour): void => {
        data.set(colour, 4 * pixel);
        data[4 * pixel + 3] = 255;
    };
    for (let pixel = 0; pixel < image.width * image.height; ++pixel) {
        if (reference) {
            const error = relativeError(image, reference, pixel);
            put(pixel, Number.isNaN(error) ? kNotANumber : sequential(error));
        } else if (image.numbers) {
            const value = image.numbers[pixel] as number;
            if (value === kNoNumber) put(pixel, kNoProbe);
            else put(pixel, layer.key === "probe" ? categorical(value) : sequential(value / how.top));
        } else if (image.halves) {
            const [r, g, b] = [
                image.halves[3 * pixel] as number,
                image.halves[3 * pixel + 1] as number,
                image.halves[3 * pixel + 2] as number,
            ];
            const broken = Number.isNaN(halfValues[r]) || Number.isNaN(halfValues[g]) || Number.isNaN(halfValues[b]);
            put(pixel, broken ? kNotANumber : [how.tones[r] as number, how.tones[g] as number, how.tones[b] as number]);
        }
    }
    context.putImageData(pixels, 0, 0);
    return canvas;
}

const part = (value: number): string => (Number.isFinite(value) ? number(value, 4) : String(value));

/** What one pixel holds, as text. `explain` says more of a probe. */
export function pixelText(loaded: Loaded, layer: Layer, x: number, y: number, explain: (entry: Entry, probe: number) => string): string {
    const { image, reference, entry } = loaded;
    if (!image) return loaded.problem;
    const pixel = y * image.width + x;
    if (reference) return `relative error ${part(relativeError(image, reference, pixel))}`;
    if (image.halves) return [0, 1, 2].map((channel) => part(halfValues[image.halves?.[3 * pixel + channel] ?? 0] as number)).join("  ");
    const value = image.numbers?.[pixel] ?? kNoNumber;
    if (value === kNoNumber) return "none";
    return layer.key === "probe" ? explain(entry, value) : String(value);
}
