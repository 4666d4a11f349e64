// The page's pure parts against definitions and brute force. See page_test.sh.
import assert from "node:assert/strict";
import { createRequire } from "node:module";
import { test } from "node:test";

const require = createRequire(`${process.env.PACKAGES}/package.json`);
const { build } = require("esbuild");

/** Bundles a module of the page's sources and loads it. */
async function load(name) {
    const { outputFiles } = await build({
        entryPoints: [`${process.env.PACKAGES}/src/${name}.ts`],
        bundle: true,
        format: "esm",
        write: false,
    });
    return import(`data:text/javascript;base64,${Buffer.from(outputFiles[0].contents).toString("base64")}`);
}
/** Numbers in [0, 1) that are the same in every run (a linear congruential generator, Knuth's MMIX constants). */
function randomNumbers(seed) {
    let state = BigInt(seed);
    return () => Number((state = (state * 6364136223846793005n + 1442695040888963407n) & 0xffffffffffffffffn) >> 11n) / 2 ** 53;
}

test("the Pareto front is what no other point beats", async () => {
    const { paretoFront } = await load("pareto");
    const random = randomNumbers(1);
    for (let round = 0; round < 200; ++round) {
        const values = Array.from({ length: Math.floor(random() * 30) }, (_, item) => ({
            x: Math.floor(random() * 8),
            y: Math.floor(random() * 8),
            item,
        }));
        const beaten = (p) =>
            values.some((q) => (q.x <= p.x && q.y < p.y) || (q.x < p.x && q.y <= p.y) || (q.x === p.x && q.y === p.y && q.item < p.item));
        const truth = values.filter((p) => !beaten(p)).sort((a, b) => a.x - b.x);
        assert.deepEqual(paretoFront(values), truth);
    }
});

test("ticks lie in the range, rise, and are few", async () => {
    const { logTicks, paddedRange } = await load("ticks");
    for (const [low, high] of [
        [1, 2],
        [0.9, 1100],
        [3e-7, 5e8],
        [30, 31],
        [99.9, 100.1],
        [1e-12, 1.5e-12],
        [0.02, 0.5],
    ]) {
        const ticks = logTicks(low, high);
        assert.ok(ticks.length >= 2 && ticks.length <= 8, `${ticks} of ${low} to ${high}`);
        assert.ok(
            ticks.every((tick, index) => tick >= low * 0.999999 && tick <= high * 1.000001 && (index === 0 || tick > ticks[index - 1])),
            `${ticks} of ${low} to ${high}`,
        );
    }
    for (const values of [[], [5], [5, 5, 5], [1e-9, 1e9], [3, 4]]) {
        const [low, high] = paddedRange(values);
        assert.ok(low > 0 && high > low * 1.05 && values.every((value) => low < value && value < high), `${low} to ${high} for ${values}`);
    }
});

test("halves have their values", async () => {
    const { halfValues } = await load("report_image");
    const known = [
        [0x0000, 0],
        [0x3c00, 1],
        [0xc000, -2],
        [0x7bff, 65504],
        [0x0400, 2 ** -14],
        [0x0001, 2 ** -24],
        [0x03ff, 1023 * 2 ** -24],
        [0x3555, 0.333251953125],
        [0x7c00, Infinity],
        [0xfc00, -Infinity],
    ];
    for (const [bits, value] of known) assert.equal(halfValues[bits], value, bits.toString(16));
    assert.ok(Number.isNaN(halfValues[0x7e00]) && Object.is(halfValues[0x8000], -0));
    for (let bits = 1; bits < 0x7c00; ++bits) assert.ok(halfValues[bits] > halfValues[bits - 1]); // rises with its bits
});

test("numbers are shown with three digits, and a dash where there are none", async () => {
    const { number, percent, megabytes, ratio, seconds } = await load("format");
    const shown = [
        [0, "0"],
        [1, "1.00"],
        [0.05, "0.0500"],
        [38.04, "38.0"],
        [123.4, "123"],
        [9999.6, "10000"],
        [262267, "262,267"],
        [1e-5, "1.00e-5"],
        [2.5e8, "2.50e8"],
        [-6, "-6.00"],
    ];
    for (const [value, text] of shown) assert.equal(number(value), text);
    for (const nothing of [null, undefined, NaN, Infinity, "7", {}])
        for (const show of [number, percent, megabytes, ratio, seconds]) assert.equal(show(nothing), "–");
    assert.equal(percent(0.97641), "97.64");
    assert.equal(megabytes(177508480), "178");
    assert.equal(ratio(0.25), "0.250×");
    assert.deepEqual([seconds(61.2), seconds(321.5), seconds(9000)], ["61.2 s", "5 min", "2.5 h"]);
});

test("colours: black for none, lighter for more, apart for probes", async () => {
    const { sequential, categorical } = await load("colour_maps");
    const light = ([r, g, b]) => 0.2126 * r + 0.7152 * g + 0.0722 * b;
    for (let step = 1; step <= 100; ++step)
        assert.ok(light(sequential(step / 100)) >= light(sequential((step - 1) / 100)) - 0.5, `step ${step}`);
    assert.deepEqual(sequential(-1), sequential(0));
    assert.deepEqual(sequential(7), sequential(1));
    const colours = Array.from({ length: 64 }, (_, index) => categorical(index));
    assert.equal(new Set(colours.map(String)).size, 64);
    assert.ok(colours.flat().every((part) => Number.isInteger(part) && part >= 0 && part <= 255));
    for (let index = 1; index < 64; ++index)
        assert.ok(
            Math.hypot(...colours[index].map((part, channel) => part - colours[index - 1][channel])) > 60,
            `probes ${index - 1} and ${index}`,
        );
});

test("error and tone curve follow their definitions", async () => {
    const { relativeError, topOf } = await load("image_layers");
    const image = (...bits) => ({ width: 1, height: 1, halves: new Uint16Array(bits), numbers: null });
    const error = relativeError(image(0x3c00, 0x4000, 0x0000), image(0x3c00, 0x3c00, 0x3c00), 0); // (1, 2, 0) against (1, 1, 1)
    assert.ok(Math.abs(error - Math.sqrt(2 / 1.01 / 3)) < 1e-12);
    assert.ok(Number.isNaN(relativeError(image(0x7e00, 0, 0), image(0, 0, 0), 0)));
    const counts = {
        width: 1000,
        height: 1,
        halves: null,
        numbers: Uint32Array.from({ length: 1000 }, (_, index) => (index < 3 ? 5000 : index < 10 ? 0xffffffff : index % 50)),
    };
    assert.equal(topOf([counts]), 49); // the highest few and those without a number don't count
});
