// Light, dark, or as the system says. The choice stands in the address, so that a link or a reload keeps it.

export type Theme = "auto" | "light" | "dark";

export function readAddress(): URLSearchParams {
    return new URLSearchParams(location.hash.includes("=") ? location.hash.slice(1) : "");
}

export function writeAddress(name: string, value: string): void {
    const address = readAddress();
    address.set(name, value);
    history.replaceState(null, "", `#${address}`);
}

export function setTheme(theme: Theme): void {
    if (theme === "auto") document.documentElement.removeAttribute("data-theme");
    else document.documentElement.setAttribute("data-theme", theme);
}

/** Tells when the system's own choice changes. */
export function onSystemTheme(changed: () => void): void {
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", changed);
}

const probe = document.createElement("i");
/** The colour that a custom property has now, for canvases. */
export function colourOf(property: string): string {
    if (!probe.isConnected) document.body.append(probe);
    probe.hidden = true;
    probe.style.color = `var(${property})`;
    return getComputedStyle(probe).color;
}
