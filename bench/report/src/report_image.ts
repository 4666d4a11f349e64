// The images that are embedded in the page: deflated, as base64. They are unpacked when they are first looked at.

export interface ReportImage {
    width: number;
    height: number;
    halves: Uint16Array | null; // RGB, 16-bit floats
    numbers: Uint32Array | null; // one a pixel; kNoNumber where there is none
}

export const kNoNumber = 0xffffffff;
const kHeader = 16; // bytes: "SCNI", width, height, kind

/** The value of each 16-bit float (IEEE 754 binary16). */
export const halfValues: Float32Array = (() => {
    const values = new Float32Array(65536);
    for (let bits = 0; bits < 65536; ++bits) {
        const sign = bits & 0x8000 ? -1 : 1;
        const exponent = (bits >> 10) & 31;
        const fraction = bits & 1023;
        if (exponent === 31) values[bits] = fraction ? NaN : sign * Infinity;
        else values[bits] = exponent ? sign * 2 ** (exponent - 15) * (1 + fraction / 1024) : sign * 2 ** -14 * (fraction / 1024);
    }
    return values;
})();

async function inflated(base64: string): Promise<ArrayBuffer> {
    const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
    return new Response(stream).arrayBuffer();
}

async function unpack(name: string): Promise<ReportImage> {
    const element = document.querySelector(`script[data-name="${CSS.escape(name)}"]`);
    if (!element) throw new Error(`the image ${name} is not in this page`);
    const buffer = await inflated(element.textContent ?? "");
    const header = new DataView(buffer, 0, kHeader);
    const width = header.getUint32(4, true);
    const height = header.getUint32(8, true);
    const halves = header.getUint32(12, true) === 0;
    return {
        width,
        height,
        halves: halves ? new Uint16Array(buffer, kHeader) : null,
        numbers: halves ? null : new Uint32Array(buffer, kHeader),
    };
}

const unpacked = new Map<string, Promise<ReportImage>>();
export function loadImage(name: string): Promise<ReportImage> {
    let image = unpacked.get(name);
    if (!image) unpacked.set(name, (image = unpack(name)));
    return image;
}
