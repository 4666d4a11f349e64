#!/usr/bin/env python3
"""Does each check of the tree find the fault that it is for? Every case plants one in a tree, a log or a source of its own."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).parent


def run(script, *arguments):
    """(exit code, what it printed)"""
    done = subprocess.run([sys.executable, HERE / script, *arguments], capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


class Tree(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)

    def write(self, path, text=""):
        (self.root / path).parent.mkdir(parents=True, exist_ok=True)
        (self.root / path).write_text(text, encoding="utf-8")


class Mirror(Tree):
    def setUp(self):
        super().setUp()
        self.write("scene/camera.h")
        self.write("scene/camera.cpp")
        self.write("shaders/shared/chart.h")
        self.write("build/release/made.h")
        self.write("tests/scene/camera_test.cpp", "TEST(Camera, Looks)\nTEST_F(Lens, Bends)\n")
        self.write("tests/shaders/chart_test.cpp")
        self.write("tests/without_test.txt", "# comment\n")

    def expect(self, code, *said):
        exit_code, text = run("mirror.py", self.root)
        self.assertEqual(exit_code, code, text)
        for words in said:
            self.assertIn(words, text)

    def test_passes_where_all_is_named(self):
        self.expect(0, "2 modules: 2 with a test of their name, 0 in")

    def test_module_without_test(self):
        self.write("scene/lens.h")
        self.expect(1, "scene/lens has no tests/scene/lens_test.cpp")
        self.write("tests/without_test.txt", "scene/lens  tests/scene/camera_test.cpp: Lens.Bends, Lens.*, Camera.Looks\n")
        self.expect(0, "3 modules: 2 with a test of their name, 1 in")

    def test_test_of_no_module(self):
        self.write("tests/scene/lens_test.cpp")
        self.expect(1, "tests/scene/lens_test.cpp names no module")
        (self.root / "tests/scene/lens_test.cpp").unlink()
        self.write("tests/properties/scenes/lens_test.cpp")
        self.expect(0)

    def test_list_that_has_aged(self):
        self.write("scene/lens.h")
        for line, fault in {"scene/lens": "write MODULE", "scene/lens  tests/gone_test.cpp: Lens.Bends": "tests/gone_test.cpp isn't there",
                            "scene/lens  tests/scene/camera_test.cpp: Lens.Breaks": "has no Lens.Breaks",
                            "scene/lens  tests/scene/camera_test.cpp: Prism.*": "has no Prism.*",
                            "scene/prism  tests/scene/camera_test.cpp: Lens.Bends": "scene/prism isn't there",
                            "scene/camera  tests/scene/camera_test.cpp: Lens.Bends": "scene/camera has tests/scene/camera_test.cpp"}.items():
            with self.subTest(line):
                self.write("tests/without_test.txt", line + "\n")
                self.expect(1, "tests/without_test.txt:1: ", fault)


class Skips(Tree):
    LOG = """      Start  1: Camera
 1/3 Test  #1: Camera .....................   Passed    0.02 sec
 2/3 Test #22: Load ...***Skipped   0.01 sec
 3/3 Test  #3: A.NameThatIsSoLongThatOnlyThreeDotsFollowIt ...***Skipped   0.01 sec

100% tests passed, 0 tests failed out of 3
"""
    OUTPUTS = """[ RUN      ] Camera.Looks
[  SKIPPED ] Camera.Looks (0 ms)
[       OK ] Camera.Turns (0 ms)
[  SKIPPED ] 1 test, listed below:
[  SKIPPED ] Camera.Looks
[  SKIPPED ] Real/Load.Scenes/3, where GetParam() = 16-byte object <C0-61> (0 ms)
"""

    def skips(self, *lines):
        self.write("may_skip.txt", "".join(line + "\n" for line in lines))
        self.write("log", self.LOG)
        self.write("outputs", self.OUTPUTS)
        return run("skips.py", self.root / "may_skip.txt", self.root / "log", self.root / "outputs")

    def test_named_skips_pass_with_their_reasons(self):
        code, text = self.skips("# comment", r"Real/Load\.Scenes/\d  the scenes are elsewhere", "A.NameThat.*  dots", "Camera.Looks  dark")
        self.assertEqual(code, 0, text)
        self.assertIn("Skipped tests: 3", text)
        self.assertIn("Real/Load.Scenes/3: the scenes are elsewhere", text)

    def test_unnamed_skip_fails(self):
        code, text = self.skips("Real/Load.*  the scenes are elsewhere", "Camera.*  dark")
        self.assertEqual(code, 1, text)
        self.assertIn("A.NameThatIsSoLongThatOnlyThreeDotsFollowIt: NOT IN", text)

    def test_unnamed_skip_in_a_suite_that_passes_fails(self):
        code, text = self.skips("Real/Load.*  the scenes are elsewhere", "A.NameThat.*  dots")
        self.assertEqual(code, 1, text)
        self.assertIn("Camera.Looks: NOT IN", text)

    def test_part_of_a_name_is_not_the_name(self):
        self.assertEqual(self.skips("Load.Scenes  elsewhere", "A.NameThat.*  dots", "Camera.*  dark")[0], 1)

    def test_line_without_reason(self):
        code, text = self.skips("Real/Load.*")
        self.assertEqual(code, 1, text)
        self.assertIn("has no reason", text)

    def of_build(self, *lines):
        self.write("may_skip.txt", "".join(line + "\n" for line in lines))
        return run("skips.py", self.root / "may_skip.txt", "--of", self.root)

    def test_line_of_no_test(self):
        self.write("CTestTestfile.cmake", 'add_test(Camera.Looks "true")\n')
        self.assertEqual(self.of_build("Camera.*  dark")[0], 0)
        code, text = self.of_build("Camera.*  dark", "Lens.Bends  gone")
        self.assertEqual(code, 1)
        self.assertIn("Lens.Bends is no test", text)

    def test_suites_of_a_program(self):
        program = self.root / "lens_tests"
        self.write("CTestTestfile.cmake", f'add_test(Lens "{program}" "--gtest_filter=Lens.*:*/Lens.*")\n')
        self.assertEqual(self.of_build("Real/Lens.Bends/0  bent")[0], 77)
        self.write("lens_tests", "#!/bin/sh\necho 'Real/Lens.\n  Bends/0  # GetParam() = 3'\n")
        program.chmod(0o755)
        self.assertEqual(self.of_build("Real/Lens.Bends/0  bent"), (0, "\n"))
        self.write("lens_tests", "#!/bin/sh\necho 'Real/Lens.\n  Bends/0  # GetParam() = 3\nCamera.\n  Looks'\n")
        code, text = self.of_build("Real/Lens.Bends/0  bent")
        self.assertEqual(code, 1, text)
        self.assertIn("Camera is no test of ctest's", text)


class Formatted(Tree):
    def test_place_is_named(self):
        self.write(".clang-format", (HERE.parents[1] / ".clang-format").read_text(encoding="utf-8"))
        self.write("scene/camera.h", "int seen();\n")
        code, text = run("formatted.py", self.root)
        if code == 77:
            self.skipTest(text)
        self.assertEqual(code, 0, text)
        self.write("shaders/shared/chart.h", "SCONCE_FN  int seen( );\n")
        self.assertEqual(run("formatted.py", self.root)[0], 0)
        self.write("scene/lens.cpp", "int  bent( );\n")
        code, text = run("formatted.py", self.root)
        self.assertEqual(code, 1, text)
        self.assertIn("scene/lens.cpp:1:", text)


if __name__ == "__main__":
    unittest.main()
