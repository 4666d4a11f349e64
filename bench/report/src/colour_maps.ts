// False colours of errors, counts and probes.

export type Colour = [number, number, number]; // 0..255

/** Black over purple and orange to pale yellow: lighter is more, in grey, too. */
const kStops: Colour[] = [
    [4, 4, 16],
    [46, 17, 96],
    [112, 31, 129],
    [178, 50, 121],
    [235, 87, 96],
    [253, 149, 104],
    [254, 207, 146],
    [252, 253, 200],
];

/** Share in [0,1]; what is beyond takes the end's colour. */
export function sequential(share: number): Colour {
    const place = Math.min(1, Math.max(0, share)) * (kStops.length - 1);
    const index = Math.min(kStops.length - 2, Math.floor(place));
    const [a, b] = [kStops[index] as Colour, kStops[index + 1] as Colour];
    const mix = (channel: 0 | 1 | 2): number => Math.round(a[channel] + (b[channel] - a[channel]) * (place - index));
    return [mix(0), mix(1), mix(2)];
}

/** A colour for each probe, neighbours in number far apart in hue. */
export function categorical(index: number): Colour {
    const hue = (index * 0.618034 * 360) % 360;
    const lightness = [0.5, 0.66, 0.38][index % 3] as number;
    const chroma = 0.62 * Math.min(lightness, 1 - lightness);
    const channel = (offset: number): number => {
        const k = (offset + hue / 30) % 12;
        return Math.round(255 * (lightness - chroma * Math.max(-1, Math.min(k - 3, 9 - k, 1))));
    };
    return [channel(0), channel(8), channel(4)];
}

export const kNoProbe: Colour = [128, 128, 128];
export const kNotANumber: Colour = [255, 0, 255];

export const css = (colour: Colour): string => `rgb(${colour.join(" ")})`;

export function gradient(): string {
    return `linear-gradient(to right, ${kStops.map(css).join(", ")})`;
}
