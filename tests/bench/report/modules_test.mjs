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

/** A default point of a method: shares of rays that are wrong within 1 % and 0.2 %, FLIP, FLIP and mean of diffuse light, ms and MB; what is null wasn't measured. */
function pointOf(method, { wrong = null, exact = null, flip = null, diffuse = null, mean = null, ms = null, mb = null, probes = 54, ...rest } = {}) {
    return {
        id: `${method}/default`,
        method,
        knob: "default",
        value: "",
        probes,
        rays: wrong === null ? null : { right_1: 1 - wrong, right_02: exact === null ? null : 1 - exact },
        error: { beauty: { flip }, diffuse: { flip: diffuse, mean } },
        frame_ms: ms === null ? null : { median: ms },
        bytes: mb === null ? null : { total: 1e6 * mb },
        ...rest,
    };
}
const said = async (points, prices = []) => (await load("opening")).openingSentences({ name: "made up", points, analysis: { prices } });

test("three sentences: each against the opponent that is hardest to beat in it", async () => {
    assert.deepEqual(
        await said([
            pointOf("b0", { wrong: 0.3, exact: 0.1, flip: 0.4, diffuse: 0.4, mean: 0.7, ms: 5, mb: 90 }),
            pointOf("ours", { wrong: 0.01, exact: 0.02, flip: 0.1, diffuse: 0.06, mean: 1.02, ms: 20, mb: 100 }),
            pointOf("b0plus", { wrong: 0.03, exact: 0.2, flip: 0.3, diffuse: 0.5, mean: 0.8, ms: 30, mb: 80, probes: 48 }),
            pointOf("sh-grid", { flip: 0.3, diffuse: 0.02, mean: 0.88, ms: 40, mb: 3 }),
            pointOf("ddgi-placed", { flip: 0.2, diffuse: 0.03, mean: 1, ms: 10, mb: 2 }),
        ]),
        [
            "With 54 probes against 48, 1.00 % of Sconce's glossy rays are wrong within 1 % of the diagonal, 3.00 % with B0+: Sconce wins by a factor of 3.00; 2.00 % within 0.2 %, 10.00 % with B0: Sconce wins by a factor of 5.00.",
            "Sconce's picture is off by FLIP 0.100, 0.200 with DDGI on Sconce's probes: Sconce wins by a factor of 2.00; its diffuse light by 0.0600 (2.0 % too bright), 0.0200 (12 % too dark) with SH grid: Sconce loses by a factor of 3.00.",
            "Sconce's frame takes 20.0 ms, 10.0 ms with DDGI on Sconce's probes: Sconce loses by a factor of 2.00; its light field takes 100 MB, 2.00 MB with DDGI on Sconce's probes: Sconce loses by a factor of 50.0.",
        ],
    );
});

test("a loss is said, a draw within 3 %, and none wrong at all", async () => {
    const verdicts = async (ours, theirs) =>
        (await said([pointOf("ours", { wrong: ours }), pointOf("b0plus", { wrong: theirs })]))[0].replace(/^.*: /, "");
    assert.equal(await verdicts(0.06, 0.03), "Sconce loses by a factor of 2.00.");
    assert.equal(await verdicts(0.0302, 0.03), "a draw.");
    assert.equal(await verdicts(0.0298, 0.03), "a draw.");
    assert.equal(await verdicts(0.0312, 0.03), "Sconce loses by a factor of 1.04.");
    assert.equal(await verdicts(0, 0), "a draw.");
    assert.equal(await verdicts(0, 0.03), "Sconce wins.");
    assert.equal(await verdicts(0.03, 0), "Sconce loses.");
});

test("no opponent is ours, a path tracer, a wrong picture or another setting", async () => {
    const { opponentsOf } = await load("opening");
    const good = { wrong: 0.001, flip: 0.001, ms: 1, mb: 1 };
    const points = [
        pointOf("ours", { wrong: 0.01, flip: 0.1, ms: 20, mb: 100 }),
        pointOf("ours-grid", good),
        pointOf("path tracer", good),
        pointOf("path tracer filtered", good),
        { ...pointOf("b0", good), wrong: "Half of the rays are wrong." },
        { ...pointOf("b0plus", good), knob: "probes", value: "1024" },
    ];
    assert.deepEqual(opponentsOf({ points }), []);
    const sentences = await said(points);
    assert.match(sentences[0], /; no opponent's rays were judged\.$/);
    assert.match(sentences[1], /; no opponent's picture was judged\.$/);
    assert.equal(sentences[2], "Sconce's frame takes 20.0 ms; its light field takes 100 MB.");
});

test("what was not measured is said", async () => {
    assert.deepEqual(await said([]), ["Sconce's default setting was not measured in this scene."]);
    assert.deepEqual(await said([pointOf("ours", { probes: null }), pointOf("wang", { wrong: 0.1, flip: 0.1 })]), [
        "Not measured of Sconce: wrong rays (not within 1 %).",
        "Not measured of Sconce: FLIP of beauty.",
        "Not measured of Sconce: frame time; not measured of Sconce: memory.",
    ]);
    assert.equal(
        (await said([pointOf("ours", { ms: 20, mb: 9 }), pointOf("wang", { flip: 0.1 })]))[2],
        "Sconce's frame takes 20.0 ms, not measured with W'; its light field takes 9.00 MB, not measured with W'.",
    );
    const wrong = await said([{ ...pointOf("ours", { wrong: 0.6 }), wrong: "More than half of the rays are answered wrongly." }]);
    assert.equal(wrong[0], "Sconce's picture is wrong here: More than half of the rays are answered wrongly.");
    assert.equal(wrong.length, 4);
});

test("the price is that of the knob that takes the least time", async () => {
    const row = (to, error_ratio, time, memory, rest) => ({
        knob: "resolution",
        error_key: "wrong_rays",
        from: "ours/default",
        to,
        error_ratio,
        time_ratio: 1.1,
        halving_costs_time: time,
        halving_costs_memory: memory,
        ...rest,
    });
    const price = async (...rows) => (await said([pointOf("ours", { ms: 20, mb: 9 })], rows))[2].split("; ")[2];
    const rows = [row("a", 0.5, 1.4, 2), row("b", 0.6, 1.2, 3), row("c", 1.5, 1.01, 1), row("d", 0.95, null, null)];
    assert.equal(await price(...rows), "half as many rays wrong within 1 % would cost 1.20× the frame time and 3.00× the memory, at the rate of resolution.");
    assert.equal(await price(rows[2], rows[3]), "no knob that was varied would buy half as many rays wrong within 1 %.");
    assert.equal(
        await price(row("a", 0.5, 1.4, null, { time_ratio: null, error_key: "glossy.relmse" })),
        "half the error of reflections would cost 1.40× the reads, at the rate of resolution.",
    );
    assert.equal(await price(), undefined);
});

test("methods have names, and every style of them is its own", async () => {
    const { methodName, methodStyles } = await load("methods");
    for (const [method, name] of Object.entries({
        ours: "Sconce",
        "path tracer filtered": "filtered path tracer",
        ddgi: "DDGI",
        "ddgi-placed": "DDGI on Sconce's probes",
        "sh-grid": "SH grid",
        "another one": "another one",
    }))
        assert.equal(methodName(method), name);
    const known = [...methodStyles([]).values()];
    assert.equal(new Set(known.map((style) => style.colour + style.outline)).size, 11);
    assert.equal(methodStyles(["ours", "another one"]).size, 12);
});
