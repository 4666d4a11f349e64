// The report's page as a reader has it: opened from a file in a browser, moved by mouse and keyboard. See page_test.sh.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { after, afterEach, before, test } from "node:test";

const require = createRequire(`${process.env.PACKAGES}/package.json`);
const { chromium } = require("playwright-core");
const axeSource = readFileSync(require.resolve("axe-core/axe.min.js"), "utf8");

let browser;
let page;
let faults; // what the page did that it must not: messages, errors, requests
before(async () => {
    browser = await chromium.launch({ executablePath: process.env.BROWSER, args: ["--no-sandbox"] });
});
after(async () => browser.close());
afterEach(async () => {
    if (page) await page.context().close();
    page = undefined;
});

async function open(name, colorScheme = "light") {
    const context = await browser.newContext({
        viewport: { width: 1280, height: 720 },
        colorScheme,
        permissions: ["clipboard-read", "clipboard-write"],
    });
    page = await context.newPage();
    page.setDefaultTimeout(600000); // ms; only to end what hangs: a busy machine takes long
    faults = [];
    const file = `file://${process.env.PAGES}/${name}/report/index.html`;
    page.on("console", (message) => faults.push(`console: ${message.text()}`));
    page.on("pageerror", (error) => faults.push(`error: ${error.stack}`));
    page.on("request", (request) => {
        if (request.url() !== file && !request.url().startsWith("data:")) faults.push(`request: ${request.url()}`);
    });
    await page.addInitScript(() => {
        window.colourAt = (canvas, u, v) => {
            const copy = new OffscreenCanvas(1, 1).getContext("2d", { willReadFrequently: true });
            copy.drawImage(canvas, -Math.floor(u * canvas.width), -Math.floor(v * canvas.height));
            return [...copy.getImageData(0, 0, 1, 1).data];
        };
    });
    await page.goto(file);
}
const noFaults = () => assert.deepEqual(faults, []);

/** Moves the mouse over a plot until it is at a point; the place, relative to the plot. */
async function findPoint(plot) {
    await plot.scrollIntoViewIfNeeded();
    const box = await plot.boundingBox();
    for (let x = 70; x < box.width - 10; x += 14)
        for (let y = 12; y < box.height - 45; y += 14) {
            await page.mouse.move(box.x + x, box.y + y);
            if (await page.evaluate(() => document.getElementById("tooltip")?.hidden === false)) return [box.x + x, box.y + y];
        }
    assert.fail("no point under the mouse");
}
const tooltip = () => page.locator("#tooltip").innerText();
const choose = (legend, label) =>
    page
        .getByRole("group", { name: legend, exact: true })
        .locator("label", { hasText: new RegExp(`^\\d?${label}$`) })
        .click();
const pane = () => page.locator("canvas.pane").first();
/** Waits until these images are left and right of the divider: they are unpacked meanwhile. */
async function expectImages(left, right) {
    for (const [side, text] of Object.entries({ left, right })) await page.locator(`.badge.${side}`).getByText(text, { exact: true }).waitFor();
}
/** Unfolds the table of all points, as a reader would. */
const openTable = () => page.locator("#points summary").click();
const values = () => page.locator(".values").innerText();

/** Waits for the frame that draws what was changed. */
const drawn = () => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));

/** The colour that a pane shows, at shares of its width and height. */
async function shown(x, y) {
    await drawn();
    return pane().evaluate((canvas, [u, v]) => window.colourAt(canvas, u, v), [x, y]);
}
async function toImages() {
    await page.locator(".viewer").scrollIntoViewIfNeeded();
    await page.waitForFunction(() => {
        const canvas = document.querySelector("canvas.pane");
        return canvas.width > 0 && window.colourAt(canvas, 0.01, 0.5)[3] > 0;
    });
}

const stills = () => page.locator("#opening .stills figure");
const said = () => page.locator("#opening li").allInnerTexts();
/** What stands under the pictures that a scene begins with, when they are drawn. */
async function captions() {
    await page.waitForFunction(() => [...document.querySelectorAll(".still")].every((place) => place.children.length > 0));
    return stills().locator("figcaption").allInnerTexts();
}

test("what a graphics card took stands beside this run's device, and what was wrong there", async () => {
    await open("typical");
    const card = page.locator("#gpu");
    assert.match(await card.locator(".note").innerText(), /made-up card · its own 0\.1 · 1920x1080/);
    assert.match(await card.locator(".wrong").innerText(), /validation/);
    const rows = card.locator(".scroll").first().locator("tbody tr");
    const cells = (row) => row.locator("th, td").allInnerTexts();
    const heads = await card.locator(".scroll").first().locator("thead th").allInnerTexts();
    const room = await cells(rows.first());
    assert.equal(room[0], "frame room");
    assert.equal(room[heads.indexOf("indirect light, ms")], "0.500", "without what a renderer has anyway");
    assert.equal(room[heads.indexOf("surface light")], "–");
    assert.equal(room.at(-1), "1980 MHz");
    assert.equal((await cells(rows.nth(1)))[heads.indexOf("indirect light, ms")], "0.375");
    assert.match((await cells(rows.nth(2)))[0], /this run: made up/);
    const rays = card.locator(".scroll").nth(1).locator("tbody tr");
    assert.deepEqual(await cells(rays.first()), ["ours", "600", "500", "0.500×", "0.400×"]);
    assert.equal((await cells(rays.nth(2)))[3], "–", "B0+ wasn't timed with cold caches");
    noFaults();
});

test("a scene begins with ours, the strongest opponent and the reference, then three sentences; the table is folded", async () => {
    await open("typical");
    const parts = await page.locator("#scene > *").evaluateAll((all) => all.map((one) => one.id));
    assert.deepEqual(parts.slice(0, 3), ["", "opening", "answers"]);
    assert.deepEqual(await captions(), ["Sconce · FLIP 0.0697 · 38.0 ms", "W' · FLIP 0.0935 · 56.0 ms", "reference · 256 paths a pixel"]);
    const boxes = await stills().evaluateAll((all) => all.map((one) => one.getBoundingClientRect().toJSON()));
    assert.ok(boxes[0].right <= boxes[1].left && boxes[1].right <= boxes[2].left, "side by side");
    assert.ok(boxes.every(({ top, bottom }) => top === boxes[0].top && bottom < 720), "in the first window, in one line");
    const sentences = await said();
    assert.equal(sentences.length, 3);
    assert.equal(sentences[0], "With 54 probes each, 1.80 % of Sconce's glossy rays are wrong within 1 % of the diagonal, 3.24 % with W': Sconce wins by a factor of 1.80; 2.80 % within 0.2 %, 4.24 % with W': Sconce wins by a factor of 1.51.");
    assert.equal(await page.locator("#points details").getAttribute("open"), null);
    assert.equal(await page.locator("#points summary").innerText(), "Table of 55 rows, one a point");
    assert.equal(await page.locator("#points table").isVisible(), false);
    noFaults();
});

test("the strongest opponent is that of the term which is shown", async () => {
    await open("typical");
    await captions();
    await choose("Pictures of", "diffuse");
    const [ours, theirs] = await captions();
    assert.match(ours, /^Sconce · FLIP 0.0900 /);
    assert.match(theirs, /^B0\+ · FLIP 0.0450 /); // better than ours
    assert.equal(await stills().nth(1).locator("canvas").getAttribute("aria-label"), "diffuse of B0+");
    await choose("Pictures of", "beauty");
    assert.match((await captions())[1], /^W' /);
    noFaults();
});

test("the first pictures have one exposure, and sentences say that ours loses", async () => {
    await open("losing");
    await captions();
    const tones = await stills().locator("canvas").evaluateAll((all) => all.map((canvas) => window.colourAt(canvas, 0.5, 0.5)[0]));
    const toneOf = (radiance) => {
        const x = 0.6 * 0.18 * radiance; // the reference is 1 everywhere, which is shown as 0.18
        const tone = (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14);
        return 255 * (1.055 * tone ** (1 / 2.4) - 0.055);
    };
    [0.5, 1, 1].forEach((radiance, index) => assert.ok(Math.abs(tones[index] - toneOf(radiance)) <= 1.5, `${tones} at ${index}`));
    assert.deepEqual(await said(), [
        "With 54 probes each, 10.00 % of Sconce's glossy rays are wrong within 1 % of the diagonal, 3.24 % with W': Sconce loses by a factor of 3.09; 15.00 % within 0.2 %, 4.24 % with W': Sconce loses by a factor of 3.54.",
        "Sconce's picture is off by FLIP 0.500, 0.0935 with W': Sconce loses by a factor of 5.35; its diffuse light by 0.900 (50 % too dark), 0.0450 (0.50 % too dark) with B0+: Sconce loses by a factor of 20.0.",
        "Sconce's frame takes 1000 ms, 56.0 ms with W': Sconce loses by a factor of 17.9; its light field takes 900 MB, 135 MB with W': Sconce loses by a factor of 6.67; half as many rays wrong within 1 % would cost 1.15× the frame time and 3.22× the memory, at the rate of probes 128.",
    ]);
    noFaults();
});

test("without an opponent, or pictures, the beginning says so", async () => {
    await open("known"); // one point
    assert.deepEqual(await captions(), ["Sconce · FLIP 0.0697 · 38.0 ms", "no opponent", "reference · 256 paths a pixel"]);
    assert.equal(await stills().nth(1).locator(".still").innerText(), "No opponent's beauty was measured.");
    assert.equal(await stills().locator("canvas").count(), 2);
    assert.match((await said())[1], /^Sconce's picture is off by FLIP 0.0697; .*; no opponent's picture was judged\.$/);
    assert.equal(await page.locator("#points summary").innerText(), "Table of 1 row, one a point");
    noFaults();
    await page.context().close();
    await open("one"); // without images
    await page.getByText("No picture of Sconce's was kept of this scene.").waitFor();
    assert.equal((await said()).length, 3);
    noFaults();
});

test("the folded table opens for a link, an address, a picked point and paper, and counts its rows", async () => {
    const folded = () => page.locator("#points details").evaluate((one) => !one.open);
    await open("typical");
    await page.getByRole("link", { name: "Points" }).click();
    assert.equal(await folded(), false);
    await page.locator("#points tbody tr").first().waitFor({ state: "visible" });
    await page.getByLabel("Filter").fill("wang");
    assert.equal(await page.locator("#points summary").innerText(), "Table of 11 rows, one a point");
    await openTable();
    assert.equal(await folded(), true);
    await page.evaluate(() => new Promise((done) => (addEventListener("hashchange", done), (location.hash = "#points"))));
    assert.equal(await folded(), false);
    await page.reload();
    assert.equal(await folded(), false, "by the address from the start");
    noFaults();
    await page.context().close();

    await open("typical");
    await page.locator(".plot").first().focus();
    await page.keyboard.press("ArrowRight");
    assert.equal(await folded(), true);
    await page.keyboard.press("Enter");
    assert.equal(await folded(), false);
    assert.ok(await page.locator("#points tr.picked").isVisible());
    await openTable();
    await page.evaluate(() => addEventListener("beforeprint", () => (window.onPaper = document.querySelector("#points details").open)));
    await page.pdf();
    assert.equal(await page.evaluate(() => window.onPaper), true);
    assert.equal(await folded(), true, "and closes again");
    await openTable();
    await page.emulateMedia({ media: "print" });
    const cut = await page.locator("#points .scroll").evaluate((one) => one.scrollHeight - one.clientHeight);
    assert.ok(cut <= 0, `${cut} pixels of the table don't come to paper`);
    noFaults();
});

test("hovered points name their method, figures and settings; a click shows all of one", async () => {
    await open("typical");
    const [x, y] = await findPoint(page.locator(".plot").first());
    const text = await tooltip();
    assert.match(text, /^(Sconce|B0\+|B0|W'|path tracer), /);
    assert.match(text, /frame time\s+[\d.]+ ms \([\d.]+ to [\d.]+\)/);
    assert.match(text, /relMSE of glossy\s+[\d.]+/);
    assert.match(text, /probes \d+ · placement \w+ · resolution \d+/); // in the order of results.json
    await page.mouse.click(x, y);
    const name = text.split("\n")[0];
    assert.equal(await page.locator(".details h3").innerText(), name);
    await page.mouse.move(5, 5);
    assert.equal(await page.locator("#tooltip").isVisible(), false);
    noFaults();
});

test("plots are walked through and zoomed by keys, and dragged", async () => {
    await open("typical");
    const plot = page.locator(".plot").first();
    await plot.focus();
    await page.keyboard.press("ArrowRight");
    assert.match(await tooltip(), /^Sconce, ranked 1\n/); // the cheapest
    await page.keyboard.press("ArrowRight");
    const second = await tooltip();
    assert.doesNotMatch(second, /^Sconce, ranked 1\n/);
    await page.keyboard.press("Enter");
    assert.equal(await page.locator(".details h3").innerText(), second.split("\n")[0]);

    const picture = () => plot.locator("canvas").evaluate((canvas) => canvas.toDataURL());
    await page.keyboard.press("Escape");
    const whole = await picture();
    await page.keyboard.press("+");
    await drawn();
    assert.notEqual(await picture(), whole);
    await page.keyboard.press("0");
    await drawn();
    assert.equal(await picture(), whole);
    const box = await plot.boundingBox();
    await page.mouse.move(box.x + 100, box.y + 60);
    await page.mouse.down();
    await page.mouse.move(box.x + 200, box.y + 160, { steps: 4 });
    await page.mouse.up();
    await drawn();
    assert.notEqual(await picture(), whole);
    noFaults();
});

test("methods are hidden and other errors chosen", async () => {
    await open("typical");
    await page.getByRole("button", { name: "path tracer" }).first().click();
    assert.equal(await page.locator("#points tbody tr").count(), 44);
    await page.getByLabel("Error", { exact: true }).selectOption({ label: "FLIP of diffuse" });
    assert.match(await page.locator(".plot-head h3").first().innerText(), /^FLIP of diffuse against frame time/);
    await page.getByLabel("Knob", { exact: true }).selectOption("probes");
    noFaults();
});

test("tables sort, with what was not measured last, and filter", async () => {
    await open("typical");
    await openTable();
    const column = (index) =>
        page.locator("#points tbody tr").evaluateAll((rows, at) => rows.map((row) => row.children[at].innerText.trim()), index);
    const head = page.locator("#points thead th", { hasText: "reads a ray" });
    await head.locator("button").focus();
    await page.keyboard.press("Enter");
    assert.equal(await head.getAttribute("aria-sort"), "ascending");
    const rising = await column(4);
    const numbers = rising.filter((text) => text !== "–").map(Number);
    assert.deepEqual(
        numbers,
        [...numbers].sort((a, b) => a - b),
    );
    assert.equal(rising.filter((text) => text === "–").length, 11);
    assert.ok(rising.slice(-11).every((text) => text === "–"));
    await page.keyboard.press("Enter"); // the head keeps the focus
    assert.equal(await head.getAttribute("aria-sort"), "descending");
    const falling = await column(4);
    assert.equal(Number(falling[0]), Math.max(...numbers));
    assert.equal(falling.at(-1), "–");

    await page.getByLabel("Filter").fill("wang resolution=10");
    assert.deepEqual(await column(1), ["resolution 1024"]);
    await page.getByLabel("Filter").fill("");
    await choose("Columns", "settings");
    assert.ok((await page.locator("#points thead").innerText()).includes("chart"));
    noFaults();
});

test("losses are shown like wins", async () => {
    await open("typical");
    const row = page.locator("#answers-scene tbody tr").first();
    assert.equal(await row.locator(".win").count(), 3);
    assert.equal(await row.locator(".loss").innerText(), "▲1.43×");
    const rows = page.locator("#answers-scene .scroll").first().locator("tbody tr:not(.said)");
    assert.equal(await rows.nth(2).locator("td").nth(1).innerText(), "no setting of ours");
    const said = page.locator("#answers-scene .scroll").first().locator(".said");
    assert.deepEqual(await said.allInnerTexts(), ["No setting of ours is as good as the path tracer."]);
    await page.getByLabel("in words").first().check();
    assert.equal(await said.count(), 3);
    await page.getByLabel("At equal", { exact: true }).selectOption("memory");
    assert.equal(await rows.count(), 1);
    noFaults();
});

test("the divider moves by mouse and keyboard", async () => {
    await open("typical");
    await toImages();
    const handle = page.getByRole("slider", { name: /Divider/ });
    const at = async () => Number(await handle.getAttribute("aria-valuenow"));
    assert.equal(await at(), 50);
    const grip = await handle.boundingBox();
    const box = await pane().boundingBox();
    await page.mouse.move(grip.x + grip.width / 2, grip.y + grip.height / 2);
    await page.mouse.down();
    await page.mouse.move(box.x + 0.25 * box.width, grip.y + 20, { steps: 5 });
    await page.mouse.up();
    assert.equal(await at(), 25);
    await handle.focus();
    await page.keyboard.press("ArrowRight");
    assert.equal(await at(), 27);
    await page.keyboard.press("End");
    assert.equal(await at(), 100);
    await page.keyboard.press("Home");
    assert.equal(await at(), 0);
    noFaults();
});

test("keys switch images and layers, and swap and show all", async () => {
    await open("typical");
    await toImages();
    await expectImages("Sconce", "reference");
    await pane().focus();
    await page.keyboard.press("2");
    await expectImages("B0+", "reference");
    await page.keyboard.press("Shift+Digit2");
    await page.keyboard.press("Shift+E");
    await expectImages("B0+", "error of B0+");
    assert.ok((await page.locator(".colours").innerText()).includes("1 and more"));
    await page.keyboard.press("x");
    await expectImages("error of B0+", "B0+");
    await page.keyboard.press("1");
    await page.keyboard.press("l");
    await page.keyboard.press("l");
    await page.keyboard.press("l");
    await page.getByText("Probe that answered (32 in view)").waitFor(); // 8 x 4 blocks
    await page.keyboard.press("ArrowRight");
    assert.match(await values(), /probe \d+ at .*: (skeleton ridge|free point|gap|pinned)/);
    await page.keyboard.press("v");
    assert.equal(await page.locator("canvas.pane").count(), 4);
    await choose("Layer", "beauty");
    await page.locator("figcaption", { hasText: "error of Sconce" }).waitFor(); // the left side's choice holds for all
    noFaults();
});

test("pixel values are the file's, whatever the exposure; zoom and crosshair are shared", async () => {
    await open("known");
    await toImages();
    await pane().focus();
    const pixel = async (x, y) => {
        const box = await pane().boundingBox();
        await page.mouse.move(box.x + ((x + 0.5) / 8) * box.width, box.y + ((y + 0.5) / 4) * box.height);
        return (await values()).split("\n").map((line) => line.trim());
    };
    assert.deepEqual((await pixel(0, 0)).slice(0, 4), ["pixel", "0, 0", "Sconce", "1.000  2.000  3.000"]);
    assert.equal((await pixel(1, 0))[3], "4.000  5.000  6.000");
    assert.match((await pixel(2, 0))[3], /^NaN /);
    assert.match((await pixel(3, 0))[3], /^Infinity /);
    assert.deepEqual((await shown(2.5 / 8, 0.125)).slice(0, 3), [255, 0, 255], "what is not a number stands out");

    const before = await shown(0.3, 0.6);
    const slider = page.getByLabel("Exposure, stops");
    await slider.focus();
    await page.keyboard.press("ArrowLeft");
    await page.keyboard.press("ArrowLeft");
    assert.equal(await page.locator("output.exposure").innerText(), "−0.50 EV");
    const darker = await shown(0.3, 0.6);
    assert.ok(darker[0] < before[0], `${darker} is darker than ${before}`);
    assert.equal((await pixel(0, 0))[3], "1.000  2.000  3.000");
    await pane().focus();
    await page.keyboard.press("]");
    assert.equal(await page.locator("output.exposure").innerText(), "−0.25 EV");

    await choose("View", "all");
    await pane().focus();
    const zoom = page.locator("output.zoom");
    const least = parseInt(await zoom.innerText(), 10);
    await page.keyboard.press("+");
    await page.keyboard.press("+");
    assert.ok(parseInt(await zoom.innerText(), 10) > least);
    await drawn();
    const same = await page.locator("canvas.pane").evaluateAll((all) => all.slice(0, 2).map((canvas) => canvas.toDataURL()));
    assert.equal(same[0], same[1], "equal images at one place look alike");
    noFaults();
});

test("the exposure and the tone curve are those of the command's PNG files", async () => {
    await open("known");
    await toImages();
    // Log-average luminance to 0.18, then the curve and sRGB, in double precision from their definitions.
    const luminance = (r, g, b) => 0.2126 * r + 0.7152 * g + 0.0722 * b;
    const all = [luminance(1, 2, 3), luminance(4, 5, 6), ...Array(8 * 4 - 4).fill(0.5)];
    const scale = 0.18 / Math.exp(all.reduce((sum, value) => sum + Math.log(value), 0) / all.length);
    const x = 0.6 * 0.5 * scale;
    const tone = (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14);
    const expected = 255 * (1.055 * tone ** (1 / 2.4) - 0.055);
    assert.ok(Math.abs((await shown(0.3, 0.9))[0] - expected) <= 1.5, `${await shown(0.3, 0.9)} is ${expected}`);
    noFaults();
});

test("probes say where they are and why", async () => {
    await open("typical");
    await page.locator("svg.plan:not(.ground)").first().focus();
    await page.keyboard.press("ArrowRight");
    assert.match(await tooltip(), /probe 0 at .*\nskeleton ridge, covers 1.2 % of the surface first/);
    const dot = await page.locator("svg.plan:not(.ground)").nth(1).locator("circle[data-probe='4']").boundingBox();
    await page.mouse.move(dot.x + dot.width / 2, dot.y + dot.height / 2);
    assert.match(await tooltip(), /grid point 4,2,0[^]*grid point 4,1,0|grid point 4,0,0[^]*grid point 4,1,0/); // all three that stand over each other
    assert.match(await page.locator(".plan-cell").nth(1).innerText(), /54 probes · grid · 6 × 3 × 3 · /);
    await choose("Seen from", "the front");
    assert.equal(await page.locator("svg.plan:not(.ground)").first().locator("circle").count(), 54);
    // With z to the right and y up one looks along x: what has less of it is nearer, and larger.
    await choose("Seen from", "the side");
    const radius = async (probe) => Number(await page.locator("svg.plan:not(.ground)").nth(1).locator(`circle[data-probe='${probe}']`).getAttribute("r"));
    assert.ok((await radius(0)) > 1.5 * (await radius(5)), "the grid's points count along x first");
    noFaults();
});

test("the theme follows the system until it is chosen, and the choice stays in the address", async () => {
    const background = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
    const axis = () =>
        page
            .locator(".plot canvas")
            .first()
            .evaluate((canvas) => canvas.toDataURL());
    await open("typical", "dark");
    const dark = await background();
    const darkPlot = await axis();
    await choose("Theme", "light");
    const light = await background();
    assert.notEqual(light, dark);
    await drawn();
    assert.notEqual(await axis(), darkPlot, "plots change with it");
    await page.reload();
    assert.equal(await background(), light);
    noFaults();
});

test("another scene is chosen and stays in the address; commands are copied", async () => {
    await open("typical");
    await choose("Scene", "made-up hall 1");
    assert.equal(await page.locator(".scene-head h2").innerText(), "made-up hall 1");
    await page.reload();
    assert.equal(await page.locator(".scene-head h2").innerText(), "made-up hall 1");
    await page.locator(".commands button").first().click();
    await page.getByText("copied").waitFor();
    assert.equal(await page.evaluate(() => navigator.clipboard.readText()), "sconce bench made-up -o out");
    noFaults();
});

test("a point's images are shown from its details", async () => {
    await open("typical");
    await openTable();
    await page.locator("#points tbody tr", { hasText: "B0+" }).first().locator("button").click();
    await page.getByRole("button", { name: "Show its images" }).click();
    await toImages();
    await expectImages("B0+", "reference");
    noFaults();
});

for (const name of ["one", "many", "names", "missing", "empty"])
    test(`odd results, ${name}: no fault, and nothing wider than the window`, async () => {
        await open(name);
        const scenes = await page.getByRole("group", { name: "Scene", exact: true }).locator("label").count();
        for (let scene = 0; scene < Math.max(1, scenes); ++scene) {
            if (scenes > 0) await page.getByRole("group", { name: "Scene", exact: true }).locator("label").nth(scene).click();
            if ((await page.locator(".viewer").count()) > 0) {
                await toImages();
                await pane().focus();
                for (let layer = 0; layer < 7; ++layer) await page.keyboard.press("l");
                await page.keyboard.press("v");
            }
            assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), "the page scrolls sideways");
        }
        assert.equal(await page.evaluate(() => "broken" in window), false);
        noFaults();
    });

test("what is missing is said, not shown as zero", async () => {
    await open("missing");
    await openTable();
    const cells = await page.locator("#points tbody tr").nth(1).locator("td").allInnerTexts();
    assert.ok(
        cells.slice(1).every((text) => text === "–"),
        cells.join(" "),
    );
    assert.match(await page.locator(".plot-cell .note").first().innerText(), /^\d+ of 55 points without a figure here$/);
    await toImages();
    await choose("Layer", "glossy");
    await page.getByText("Sconce has no image of glossy.").waitFor();
    await choose("Scene", "nothing but a name");
    await page.getByText("This scene has no images.").waitFor();
    noFaults();
});

test("results of another schema are refused in words", async () => {
    await open("schema");
    assert.match(await page.getByRole("alert").innerText(), /schema 1, this page reads schema 2/);
});

test("no serious fault of accessibility, light and dark", async () => {
    for (const theme of ["light", "dark"]) {
        await open("typical", theme);
        await toImages();
        await openTable();
        await page.locator("#points tbody button").first().click();
        await page.evaluate(axeSource);
        const rules = theme === "light" ? {} : { runOnly: ["color-contrast"] }; // the rest doesn't depend on the theme
        const { violations } = await page.evaluate((options) => window.axe.run({ resultTypes: ["violations"], ...options }), rules);
        const serious = violations.filter((one) => ["serious", "critical"].includes(one.impact));
        assert.deepEqual(
            serious.map((one) => `${theme}: ${one.id}: ${one.nodes.map((node) => `${node.target} ${node.failureSummary}`).join("; ")}`),
            [],
        );
        await page.context().close();
        page = undefined;
    }
});
