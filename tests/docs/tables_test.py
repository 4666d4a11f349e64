#!/usr/bin/env python3
"""Faults planted in a copy of the tree: bench/pages/tables.py --check must fail for each, and name where it is and what it is."""
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def skipped(folder, names):
    """What the pages don't depend on: hidden folders and builds."""
    of_root = {"build", "out", "shared"} if Path(folder) == ROOT else set()
    return [name for name in names if name.startswith(".") or name in of_root or name in ("node_modules", "__pycache__")]


class Tables(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="sconce-docs-")
        cls.tree = Path(cls.folder.name) / "tree"
        shutil.copytree(ROOT, cls.tree, ignore=skipped)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def setUp(self):
        self.kept = {}

    def tearDown(self):
        for path, text in self.kept.items():
            path.write_text(text)

    def run_script(self, *arguments):
        command = [sys.executable, "-B", self.tree / "bench/pages/tables.py", *arguments]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        return done.returncode, done.stdout + done.stderr

    def change(self, name, pattern, replacement):
        """Replaces the pattern's first place in a file of the copy; returns the line that it is on."""
        path = self.tree / name
        text = path.read_text()
        self.kept.setdefault(path, text)
        match = re.search(pattern, text)
        self.assertIsNotNone(match, f"{name} has nothing like {pattern}")
        path.write_text(text[: match.start()] + match.expand(replacement) + text[match.end() :])
        return text.count("\n", 0, match.start()) + 1

    def expect_fault(self, *parts):
        code, said = self.run_script("--check")
        self.assertEqual(code, 1, said)
        for part in parts:
            self.assertIn(part, said)

    def test_untouched_tree_passes(self):
        code, said = self.run_script("--check")
        self.assertEqual(code, 0, said)

    def test_changed_table_cell(self):
        line = self.change("docs/accuracy.md", r"\| B0\+, same probes and lists \| [\d.]+ / ", "| B0+, same probes and lists | 12.34 / ")
        self.expect_fault(f"docs/accuracy.md:{line}: table sponza_rays.json main", "12.34 / ", "the file gives")

    def test_row_taken_from_a_table(self):
        line = self.change("docs/light.md", r"\| hall, 24 \|.*\n", "")
        self.expect_fault(f"docs/light.md:{line}: table surface_light.json main")

    def test_optional_column_comes_with_its_rows(self):
        self.change("bench/pages/views.json", r'(\["KiB a probe", )', r'["made up", "{made_up}", {"optional": true}], \1')
        code, said = self.run_script("--check")
        self.assertEqual(code, 0, said)
        self.change("bench/results/surface_light.json", r'("label": "hall, 24")', r'\1, "made_up": "7.5"')
        self.expect_fault("docs/light.md:", "table surface_light.json main", "| made up |", "| 7.5 |")

    def test_optional_group_comes_with_its_rows(self):
        self.change("bench/pages/views.json", r'("groups": \{)("light: none)', r'\1"made up": "^made up", \2')
        self.expect_fault("docs/limits.md:", "table hard_cases.csv groups: \"group 'made up' is empty\"")
        self.change("bench/pages/views.json", r'(subgroups\|shaders\)"\})', r'\1, "optional": ["made up"]')
        code, said = self.run_script("--check")
        self.assertEqual(code, 0, said)
        self.change("bench/results/hard_cases.csv", r"(case,inputs,worst,bound\n)", r"\1made up,10,1,2\n")
        self.expect_fault("docs/limits.md:", "| made up | 1 | 0 | made up | 1 | 2 |")

    def test_target_that_is_no_longer_reached(self):
        self.change("bench/results/findings.json", r'("surface_asked": .*?"flip": ")[\d.]+', r"\g<1>0.0001")
        self.change("bench/results/findings.json", r'("surface_asked": .*?"mean": ")[^"]+', r"\g<1>5 to 6")
        line = self.change("docs/light.md", r"\| hall, 24 \|", "| hall, 24 |")
        code, said = self.run_script("--check")
        self.assertEqual(code, 1, said)
        stands, gives = re.search(rf"docs/light\.md:{line}: .*: there stands '(.*)', the file gives '(.*)'", said).groups()
        self.assertLess(gives.count("**"), stands.count("**"), "FLIP")
        self.assertNotIn("*", gives.split("|")[4], "mean")

    def test_number_in_prose_that_contradicts_its_file(self):
        line = self.change("docs/accuracy.md", r"(<!--=tess10m\.bake-->)[\d.]+", r"\g<1>0.09")
        self.expect_fault(f"docs/accuracy.md:{line}: findings:tess10m.bake: there stands '0.09', the file gives '199'")

    def test_result_file_that_changed(self):
        self.change("bench/results/sponza_rays.json", r'("label": "Sconce".*?"right_02": ")[\d.]+', r"\g<1>12.34")
        self.expect_fault("README.md:", "docs/accuracy.md:", "12.34")

    def test_row_that_no_file_has(self):
        line = self.change("README.md", r"<!--=sponza_rays:embree", "<!--=sponza_rays:embroe")
        self.expect_fault(f"README.md:{line}:", "sponza_rays has no row 'embroe'")

    def test_format_version_of_the_page(self):
        line = self.change("docs/formats.md", r"u32 version \(\d+\)", "u32 version (3)")
        self.expect_fault(f"docs/formats.md:{line}: there stands version 3 of .sconce, the code writes")

    def test_format_version_of_the_code(self):
        header = next(path for path in self.tree.rglob("*.h") if "kFieldFileVersion = " in path.read_text(errors="replace"))
        self.change(header.relative_to(self.tree), r"kFieldFileVersion = \d+", "kFieldFileVersion = 77")
        self.expect_fault("docs/formats.md:", "the code writes 77")

    def test_bare_number_in_prose(self):
        for name, heading in (("README.md", "## What it measures"), ("docs/accuracy.md", "## Rays")):
            with self.subTest(name):
                line = self.change(name, re.escape(heading) + "\n", heading + "\n\nIt is right on 99.99 % of all rays.\n") + 2
                self.expect_fault(f"{name}:{line}: '99.99 %' looks measured")

    def test_broken_links(self):
        line = self.change("docs/integrate.md", r"\]\(light\.md", "](lights.md")
        other = self.change("docs/integrate.md", r"accuracy\.md#prices", "accuracy.md#no-levels")
        self.expect_fault(f"docs/integrate.md:{line}: link to 'lights.md#plan-and-tiles': there is no such file",
                          f"docs/integrate.md:{other}: link to 'accuracy.md#no-levels': there is no such heading")

    def test_source_that_is_not_there(self):
        line = self.change("docs/overview.md", r"`probe_trace\.h`", "`probe_tracer.h`")
        self.expect_fault(f"docs/overview.md:{line}: names 'probe_tracer.h'")

    def test_results_without_command_or_commit(self):
        self.change("bench/results/knobs.json", r'"command": "[^"]+"', '"command": ""')
        self.change("bench/results/walls.json", r'"commit": "\w+"', '"commit": "ec3004"')
        self.change("bench/results/hard_cases.csv", r"# commit: \w+\n", "")
        self.change("bench/results/findings.json", r'"commit": "\w+"', '"commit": "today"')
        self.expect_fault("knobs.json:1: names no command", "walls.json:1: names no commit", "hard_cases.csv:1: names no commit",
                          "findings.json:1: row ")

    def test_what_falls_short_stands_in_readme(self):
        self.change("bench/results/hard_cases.csv", r"(\"rays within a texel of silhouettes: leaks\",\d+,[\d.]+),\"?[\d.]+\"?", r'\1,"0.03; SHORT of 0.01"')
        self.expect_fault("'rays_within_a_texel_of_silhouettes_leaks' is short of what is asked (0.03; SHORT of 0.01)")

    def test_a_caption_says_what_its_figures_are_older_than(self):
        self.change("bench/results/walls.json", r'("commit": "\w+",)', r'\1 "older": "the curtain is of another cloth",')
        self.expect_fault("; older: the curtain is of another cloth*'")

    def test_too_many_bytes(self):
        self.change("docs/limits.md", r"\Z", "\n" + "There is more that can't be told here. " * 200)
        self.expect_fault("docs:0: the pages have", "64000 are allowed")

    def test_writing_mends_tables_and_figures(self):
        page = self.tree / "docs/accuracy.md"
        before = page.read_text()
        self.change("docs/accuracy.md", r"\| B0\+, same probes and lists \| [\d.]+ / ", "| B0+, same probes and lists | 12.34 / ")
        self.change("docs/accuracy.md", r"(<!--=tess10m\.bake-->)[\d.]+", r"\g<1>0.09")
        broken = page.read_text()
        self.run_script("--check")
        self.assertEqual(page.read_text(), broken, "--check must change nothing")
        code, said = self.run_script()
        self.assertEqual(code, 0, said)
        self.assertEqual(page.read_text(), before)


if __name__ == "__main__":
    unittest.main()
