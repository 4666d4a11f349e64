#!/usr/bin/env python3
"""Fills the pages' tables and figures from the result files, or says where a page is not what they give.

    python3 bench/pages/tables.py            writes README.md and docs/*.md
    python3 bench/pages/tables.py --check    changes nothing; exits 1 and names page, line, what stands there and what the file gives

In a page, `<!-- table: FILE VIEW -->` ... `<!-- /table -->` holds a table of bench/results/FILE, by the view of that name in views.json;
`<!--=FILE:ROW.KEY-->figure<!--/-->` holds one figure (FILE without its ending, none for findings.json; of a .csv, ROW is the first
cell's slug).

A result file holds what was printed, to the digit: `what`, `command`, `commit`, `machine`, perhaps `notes`, and `rows`, each with its own
keys. A .csv has the same head as lines `# key: value`. A row of findings.json names its own command and commit.

A view names columns (header, template) and rows. `{key}` is the row's value; `{part.key}` that of the row `ROW__part`; `{@}` the row's
name in the view. A cell whose values are all empty is empty. `"caption": false`: no line below it. A column's third entry may have
`"bold_up_to"`, by which cells are marked that reach a target: a key of the row, or `ROW.KEY` of findings.json, there also a range,
`LOW to HIGH`; and `"optional": true`: left out where no row has a value. Groups named in a view's `"optional"` may be empty, and are left out.
"""
import argparse
import csv
import json
import re
import sys
from pathlib import Path

BYTES_OF_DOCS = 64_000
SKIPPED_FOLDERS = {"build", "out", "shared"} # of the root

TABLE = re.compile(r"^<!-- table: (\S+) (\S+) -->\n(.*?)^<!-- /table -->$", re.M | re.S)
FIGURE = re.compile(r"<!--=(?:(\w+):)?(\w+)\.(\w+)-->(.*?)<!--/-->", re.S)
MEASURED = re.compile(r"(?<![\w.])\d[\d,]*(?:\.\d+)?\s?%|(?<![\w.])\d+\.\d+(?![\w.]*\w*\()")

# Numbers in prose that no run printed, with the reason why each may stand there.
ALLOWED = [
    (r"Vulkan 1\.3|OpenEXR 3\.1", "a version"),
    (r"section \d\.\d", "a place in a paper"),
    (r"within (?:1|0\.2) %", "the tolerance by which a ray is judged"),
    (r"alpha 0\.1 to 0\.3|roughness 0\.\d+", "a setting of what was measured"),
    (r"b\^2 \+ 0\.01", "the floor in relMSE's definition"),
]
# Of README only this section holds measurements; its table of knobs is prose by hand.
README_SECTION = "## What it measures"


def slug(text):
    return re.sub(r"[^a-z0-9]+", "_", text.lower()).strip("_")


class Results:
    """The result files, read once."""

    def __init__(self, folder):
        self.folder = folder
        self.files = {}

    def file(self, name):
        """name: with its ending"""
        if name not in self.files:
            path = self.folder / name
            self.files[name] = read_csv(path) if name.endswith(".csv") else json.loads(path.read_text())
        return self.files[name]

    def named(self, stem):
        for ending in (".json", ".csv"):
            if (self.folder / (stem + ending)).exists():
                return self.file(stem + ending)
        raise KeyError(f"there is no result file '{stem}'")

    def value(self, stem, row, key):
        rows = self.named(stem)["rows"]
        if row not in rows:
            raise KeyError(f"{stem} has no row '{row}'")
        if key not in rows[row]:
            raise KeyError(f"row '{row}' of {stem} has no '{key}'")
        return rows[row][key]


def read_csv(path):
    lines = path.read_text().splitlines()
    head = dict(line[2:].split(": ", 1) for line in lines if line.startswith("# "))
    rows = list(csv.DictReader(line for line in lines if not line.startswith("# ")))
    return {**head, "rows": {slug(next(iter(row.values()))): row for row in rows}}


def fill(template, rows, key, name):
    found = []

    def one(match):
        field = match[1]
        if field == "@":
            return name
        part, _, own = field.rpartition(".")
        row = rows.get(f"{key}__{part}" if part else key, {})
        if part and not row:
            found.append("")
            return ""
        found.append(row.get(own, ""))
        return found[-1]

    text = re.sub(r"\{([@\w.]+)\}", one, template)
    return "" if found and not any(found) else text


def leading(text):
    match = re.match(r"[\d.]+", text)
    return float(match[0]) if match else float("inf")


def reaches(cell, target):
    """Whether a cell's first number is at most the target, or within it."""
    low, _, high = target.rpartition(" to ")
    value = leading(cell)
    return value != float("inf") and leading(high) != float("inf") and (not low or leading(low) <= value) and value <= leading(high)


def table_lines(result, view, results):
    rows = result["rows"]
    names = view.get("rows", list(rows))
    names = dict(zip(names, names)) if isinstance(names, list) else names
    lines = []
    for key, name in names.items():
        if key not in rows and not any(other.startswith(key + "__") for other in rows):
            raise KeyError(f"no row '{key}'")
        cells = []
        for _, template, *more in view["columns"]:
            cell = fill(template, rows, key, name)
            bound = more[0].get("bold_up_to") if more else None
            if bound and reaches(cell, results.value("findings", *bound.split(".")) if "." in bound else rows[key].get(bound, "")):
                cell = f"**{cell}**"
            cells.append(cell)
        lines.append(cells)
    kept = [i for i, (_, _, *more) in enumerate(view["columns"]) if not (more and more[0].get("optional")) or any(cells[i] for cells in lines)]
    return [view["columns"][i][0] for i in kept], [[cells[i] for i in kept] for cells in lines]


def group_lines(result, view):
    """Rows counted by what their first cell begins with, each group with the row that is nearest to its bound,
    one that falls short of what was aimed at before all others."""
    groups = {name: [] for name in view["groups"]}
    for row in result["rows"].values():
        case = next(iter(row.values()))
        name = next((name for name, pattern in view["groups"].items() if re.search(pattern, case)), None)
        if name is None:
            raise KeyError(f"no group holds '{case}'")
        groups[name].append(row)
    lines = []
    for name, members in groups.items():
        if not members and name in view.get("optional", []):
            continue
        if not members:
            raise KeyError(f"group '{name}' is empty")

        def share(row):
            bound, worst = leading(row["bound"]), float(row["worst"])
            return worst / bound if bound > 0 else float(worst != 0)

        nearest = max(members, key=lambda row: ("SHORT" in row["bound"], share(row)))
        exact = str(sum(row["worst"] == "0" for row in members))
        shown = [next(iter(nearest.values())), nearest["worst"], nearest["bound"]] if share(nearest) > 0 else ["", "", ""]
        lines.append([name, str(len(members)), exact, *shown])
    return ["", "cases", "exactly 0", "nearest to its bound", "worst", "bound"], lines


def render(results, views, file, name, depth):
    """The text between a table's markers."""
    result = results.file(file)
    view = views[file][name]
    header, lines = group_lines(result, view) if "groups" in view else table_lines(result, view, results)
    numbers = [all(re.match(r"[*<\-\d]|$", cells[i]) for cells in lines) for i in range(len(header))]
    out = ["| " + " | ".join(header) + " |", "|" + "|".join("---:" if right else "---" for right in numbers) + "|"]
    out += ["| " + " | ".join(cells) + " |" for cells in lines]
    if view.get("caption", True):
        stem = file.rpartition(".")[0]
        commit = f", {result['commit'][:10]}" if "commit" in result else ""
        older = f"; older: {result['older']}" if "older" in result else ""
        out += ["", f"*[{stem}]({depth}bench/results/{file}){commit}{older}*"]
    return "\n".join(out) + "\n"


def line_of(text, offset):
    return text.count("\n", 0, offset) + 1


def filled(path, text, results, views, faults):
    """The page as its result files give it; what differs goes to faults as (line, sentence)."""
    depth = "../" if path.parent.name == "docs" else ""

    def table(match):
        file, name, old = match[1], match[2], match[3]
        try:
            new = render(results, views, file, name, depth)
        except (KeyError, OSError) as error:
            faults.append((line_of(figured, match.start()), f"table {file} {name}: {error}"))
            return match[0]
        if new != old:
            first = line_of(figured, match.start(3))
            stands, gives = old.splitlines(), new.splitlines()
            for i in range(max(len(stands), len(gives))):
                a = stands[i] if i < len(stands) else "(nothing)"
                b = gives[i] if i < len(gives) else "(nothing)"
                if a != b:
                    faults.append((first + i, f"table {file} {name}: there stands '{a}', the file gives '{b}'"))
        return f"<!-- table: {file} {name} -->\n{new}<!-- /table -->"

    def figure(match):
        stem, row, key, old = match.groups()
        stem = stem or "findings"
        try:
            new = results.value(stem, row, key)
        except KeyError as error:
            faults.append((line_of(text, match.start()), f"{stem}:{row}.{key}: {error.args[0]}"))
            return match[0]
        if new != old:
            faults.append((line_of(text, match.start()), f"{stem}:{row}.{key}: there stands '{old}', the file gives '{new}'"))
        return match[0][: match.start(4) - match.start()] + new + "<!--/-->"

    figured = FIGURE.sub(figure, text) # first: it moves no line
    return TABLE.sub(table, figured)


def blank(match):
    return re.sub(r"[^\n]", " ", match[0])


def prose(text):
    """What a person wrote: neither code nor what is between markers nor where links go; lines stay where they are."""
    for pattern in (TABLE, FIGURE, re.compile(r"^```.*?^```$", re.M | re.S), re.compile(r"`[^`\n]*`"), re.compile(r"<!--.*?-->", re.S),
                    re.compile(r"\]\([^)]*\)")):
        text = pattern.sub(blank, text)
    return text


def bare_numbers(path, text):
    words = prose(text)
    if path.name == "README.md":
        begin = words.index(README_SECTION)
        end = words.find("\n## ", begin)
        words = re.sub(r"[^\n]", " ", words[:begin]) + words[begin:end]
    for pattern, _ in ALLOWED:
        words = re.sub(pattern, blank, words)
    return [(line_of(words, match.start()), f"'{match[0].strip()}' looks measured and stands outside of markers: take it from a result file")
            for match in MEASURED.finditer(words)]


def anchors(text):
    names = set()
    for heading in re.findall(r"^#+ (.*)$", re.sub(r"^```.*?^```$", "", text, flags=re.M | re.S), re.M):
        names.add(re.sub(r"[^\w\- ]", "", heading.lower()).strip().replace(" ", "-"))
    return names


def links(path, text):
    faults = []
    for match in re.finditer(r"\]\(([^)\s]+)\)", text):
        target, _, anchor = match[1].partition("#")
        if re.match(r"[a-z]+:", target):
            continue
        file = (path.parent / target).resolve() if target else path
        if not file.exists():
            faults.append((line_of(text, match.start()), f"link to '{match[1]}': there is no such file"))
        elif anchor and anchor not in anchors(file.read_text()):
            faults.append((line_of(text, match.start()), f"link to '{match[1]}': there is no such heading"))
    return faults


class Tree:
    """The files and folders that pages and commands may name."""

    def __init__(self, root):
        self.files = []
        folders = [root]
        pending = [root]
        while pending:
            for entry in pending.pop().iterdir():
                skipped = entry.name in ("node_modules", "__pycache__") or entry.name.startswith(".")
                if skipped or (entry.parent == root and entry.name in SKIPPED_FOLDERS):
                    continue
                if entry.is_dir() and not entry.is_symlink():
                    pending.append(entry)
                    folders.append(entry)
                else:
                    self.files.append(entry)
        self.paths = ["/" + file.relative_to(root).as_posix() for file in self.files + folders]

    def has(self, name):
        """Whether a path ends in it: so a page may name a file without its folder."""
        return any(path.endswith("/" + name.strip("/")) for path in self.paths)


def named_sources(text, tree):
    """What a page names in backticks and looks like a source or a folder of the tree is in it."""
    faults = []
    for match in re.finditer(r"`([\w./-]+\.(?:h|cpp|comp|glsl|frag|vert|sh|py|ts)|[\w-]+(?:/[\w-]+)*/|(?:bench|tests|shaders)/[\w./-]+)`", text):
        if not tree.has(match[1]):
            faults.append((line_of(text, match.start()), f"names '{match[1]}', which the tree doesn't have"))
    return faults


def version_faults(text, tree):
    """formats.md says the version of .sconce that the code writes."""
    written = set()
    for file in tree.files:
        if file.suffix == ".h":
            written |= set(re.findall(r"\bkFieldFileVersion = (\d+)", file.read_text(errors="replace")))
    if len(written) != 1:
        return [(1, f"kFieldFileVersion, the version of .sconce that the code writes, was found {len(written)} times")]
    code = written.pop()
    said = [(line_of(text, match.start()), match[1]) for match in re.finditer(r"u32 version \((\d+)\)", text)]
    if not said:
        return [(1, "says no version of .sconce: 'u32 version (N)'")]
    return [(line, f"there stands version {page} of .sconce, the code writes {code}") for line, page in said if page != code]


def result_faults(folder, tree, pages):
    faults = []
    results = Results(folder)
    for path in sorted(folder.iterdir()):
        try:
            result = results.file(path.name)
        except (ValueError, KeyError) as error:
            faults.append((path, 1, f"can't be read: {error}"))
            continue
        parts = {"": result} if "command" in result else {f"row '{key}': ": row for key, row in result["rows"].items()}
        for where, part in parts.items():
            if not part.get("command"):
                faults.append((path, 1, where + "names no command"))
            for script in re.findall(r"[\w./-]+\.sh\b", part.get("command", "")):
                if not tree.has(script):
                    faults.append((path, 1, where + f"names the command '{script}', which the tree doesn't have"))
            if not re.fullmatch(r"[0-9a-f]{10,40}", part.get("commit", "")):
                faults.append((path, 1, where + "names no commit of 10 or more hex digits"))
        if not result.get("machine"):
            faults.append((path, 1, "names no machine"))
        if not result["rows"]:
            faults.append((path, 1, "has no rows"))
        if path.name == "findings.json":
            faults += [(path, 1, f"row '{key}' is quoted by no page") for key in result["rows"] if not re.search(rf"<!--=(?:findings:)?{key}\.", pages)]
    return faults


def short_faults(root, results, readme):
    """Whatever a hard case falls short of stands in README."""
    file = root / "bench/results/hard_cases.csv"
    if not file.exists():
        return []
    return [(file, 1, f"'{key}' is short of what is asked ({row['bound']}), and README doesn't say so")
            for key, row in results.file(file.name)["rows"].items() if "SHORT" in row["bound"] and f"<!--=hard_cases:{key}.worst-->" not in readme]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="change nothing; exit 1 and name what differs")
    parser.add_argument("--root", type=Path, default=Path(__file__).resolve().parents[2], help="of the tree")
    arguments = parser.parse_args()
    root = arguments.root.resolve()
    results = Results(root / "bench/results")
    views = json.loads((root / "bench/pages/views.json").read_text())
    documents = sorted((root / "docs").glob("*.md"))
    tree = Tree(root)
    paths = [root / "README.md", *documents]

    complaints = result_faults(root / "bench/results", tree, "".join(path.read_text() for path in paths))
    for path in paths:
        text = path.read_text()
        differs, others = [], []
        new = filled(path, text, results, views, differs)
        if not arguments.check and new != text:
            path.write_text(new)
            print(f"{path.relative_to(root)}: {len(differs)} places written")
            text = new
            differs = []
            filled(path, text, results, views, differs) # what can't be written
        others += bare_numbers(path, text) + links(path, text) + named_sources(text, tree)
        if path.name == "formats.md":
            others += version_faults(text, tree)
        complaints += [(path, line, sentence) for line, sentence in differs + others]
    complaints += short_faults(root, results, paths[0].read_text())
    size = sum(path.stat().st_size for path in documents)
    if size > BYTES_OF_DOCS:
        complaints.append((root / "docs", 0, f"the pages have {size} bytes together, {BYTES_OF_DOCS} are allowed"))
    for path, line, sentence in complaints:
        print(f"{path.relative_to(root)}:{line}: {sentence}", file=sys.stderr)
    if arguments.check and not complaints:
        print(f"{len(documents) + 1} pages are what their results give; docs have {size} of {BYTES_OF_DOCS} bytes")
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
