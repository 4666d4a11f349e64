// A canvas that shows one image, or two with a divider between them, at a place and size that all panes share.

export interface View {
    zoom: number; // CSS pixels an image pixel takes; 0: the whole image
    x: number; // the image's pixel in the middle
    y: number;
}

export interface Pane {
    canvas: HTMLCanvasElement;
    /** Draws; `split` is the share of the width left of the divider. */
    draw(left: HTMLCanvasElement | null, right: HTMLCanvasElement | null, split: number, view: View, cursor: [number, number] | null): void;
    /** The image's pixel under a place of the window; it may lie outside the image. */
    pixelAt(clientX: number, clientY: number, view: View): [number, number];
    /** CSS pixels an image pixel takes, as drawn. */
    zoomOf(view: View): number;
}

export function imagePane(width: number, height: number, label: string): Pane {
    const canvas = document.createElement("canvas");
    canvas.className = "pane";
    canvas.style.aspectRatio = `${Math.max(1, width)} / ${Math.max(1, height)}`;
    canvas.setAttribute("aria-label", label);
    const zoomOf = (view: View): number => view.zoom || canvas.clientWidth / Math.max(1, width) || 1;
    return {
        canvas,
        zoomOf,
        pixelAt(clientX, clientY, view) {
            const area = canvas.getBoundingClientRect();
            const zoom = zoomOf(view);
            return [
                Math.floor(view.x + (clientX - area.left - area.width / 2) / zoom),
                Math.floor(view.y + (clientY - area.top - area.height / 2) / zoom),
            ];
        },
        draw(left, right, split, view, cursor) {
            const scale = devicePixelRatio;
            const [w, hgt] = [Math.round(canvas.clientWidth * scale), Math.round(canvas.clientHeight * scale)];
            if (canvas.width !== w) canvas.width = w;
            if (canvas.height !== hgt) canvas.height = hgt;
            const context = canvas.getContext("2d");
            if (!context || w === 0 || hgt === 0) return;
            context.setTransform(1, 0, 0, 1, 0, 0);
            context.clearRect(0, 0, w, hgt);
            const zoom = zoomOf(view) * scale;
            const seam = Math.round(split * w);
            const side = (image: HTMLCanvasElement | null, from: number, to: number): void => {
                if (!image || to <= from) return;
                context.save();
                context.beginPath();
                context.rect(from, 0, to - from, hgt);
                context.clip();
                context.setTransform(zoom, 0, 0, zoom, w / 2 - view.x * zoom, hgt / 2 - view.y * zoom);
                context.imageSmoothingEnabled = zoom < 3; // larger, every pixel is seen as it is
                context.imageSmoothingQuality = "high";
                context.drawImage(image, 0, 0);
                context.restore();
            };
            side(left, 0, seam);
            side(right, seam, w);
            if (!cursor) return;
            const size = Math.max(zoom, 7 * scale);
            const [cx, cy] = [w / 2 + (cursor[0] + 0.5 - view.x) * zoom, hgt / 2 + (cursor[1] + 0.5 - view.y) * zoom];
            for (const [colour, line] of [
                ["#000", 3],
                ["#fff", 1],
            ] as const) {
                context.strokeStyle = colour;
                context.lineWidth = line * scale;
                context.strokeRect(cx - size / 2, cy - size / 2, size, size);
            }
        },
    };
}
