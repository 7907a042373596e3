"""The check of includes and citations finds planted violations, and only those."""

import importlib.util
import subprocess
import sys
import tempfile
import unittest
from importlib.machinery import SourceFileLoader
from pathlib import Path

sys.dont_write_bytecode = True
SCRIPT = Path(__file__).resolve().parent / "check_includes"
_loader = SourceFileLoader("check_includes", str(SCRIPT))
check = importlib.util.module_from_spec(importlib.util.spec_from_loader("check_includes", _loader))
_loader.exec_module(check)

BIBLIOGRAPHY = "@article{Kutz17,\n title = {A}\n}\n@book{Galtier13,\n title = {B}\n}\n"


class Tree(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        self.write("docs/references.bib", BIBLIOGRAPHY)
        self.write("freepath/base/error.h", "#pragma once\n")

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def violations(self):
        return check.check_tree(self.root)

    def assert_one(self, *parts):
        found = self.violations()
        self.assertEqual(len(found), 1, found)
        for part in parts:
            self.assertIn(part, found[0])


class Includes(Tree):
    def test_accepts_the_arrows_and_what_follows_from_them(self):
        self.write("freepath/media/a.h", '#include "freepath/base/error.h"\n#include <vector>\n')
        self.write("freepath/transport/a.cpp", '#include "freepath/media/a.h"\n'
                   '#define HWY_TARGET_INCLUDE "freepath/transport/a.cpp"\n'
                   "#include <hwy/foreach_target.h>\n")
        self.write("freepath/scene/a.cpp", '#include "freepath/tracking/a.h"\n')
        self.write("apps/freepath/a.cpp", '#include "freepath/media/a.h"\n'
                   '#include "apps/freepath/commands.h"\n')
        self.write("tests/a.cpp", '#include "freepath/scene/a.h"\n#include "tests/statistics.h"\n')
        self.assertEqual(self.violations(), [])

    def test_media_and_tracking_never_meet(self):
        self.write("freepath/media/a.cpp", '\n#include "freepath/tracking/walk.h"\n')
        self.write("freepath/tracking/b.h", '#  include <freepath/media/medium.h>\n')
        found = self.violations()
        self.assertEqual([text.split(" ")[0] for text in found],
                         ["freepath/media/a.cpp:2:", "freepath/tracking/b.h:1:"])

    def test_no_arrow_points_up(self):
        self.write("freepath/base/a.h", '#include "freepath/media/field.h"\n')
        self.assert_one("freepath/base/a.h:1:", "base may not include", "no other room")

    def test_io_does_not_use_transport(self):
        self.write("freepath/io/a.cpp", '#include "freepath/transport/facade.h"\n')
        self.assert_one("freepath/io/a.cpp:1:", "io uses base, media")

    def test_the_library_knows_nothing_beside_it(self):
        self.write("freepath/scene/a.cpp", '#include "apps/freepath/commands.h"\n')
        self.assert_one("the library may not include")

    def test_the_program_does_not_use_tests(self):
        self.write("apps/freepath/a.cpp", '#include "tests/statistics.h"\n')
        self.assert_one("apps may not include")

    def test_names_start_at_the_root(self):
        self.write("freepath/media/a.cpp", '#include "medium.h"\n')
        self.assert_one("freepath/media/a.cpp:1:", "from the root")

    def test_a_file_outside_the_rooms_is_named(self):
        self.write("freepath/media/a.cpp", '#include "freepath/attic/a.h"\n')
        self.assert_one("none of the rooms")


class Lengths(Tree):
    def test_a_file_of_more_than_400_lines_is_named(self):
        self.write("freepath/base/a.h", "\n" * 400)
        self.assertEqual(self.violations(), [])
        self.write("freepath/base/a.h", "\n" * 401)
        self.assert_one("freepath/base/a.h:400:", "more than 400 lines")


class Citations(Tree):
    def test_accepts_known_keys_in_all_their_forms(self):
        self.write("freepath/base/a.h", "/// [Kutz17], [Kutz17, Eq. 21], [Galtier13, Kutz17]\n"
                   "int a[2];  /* [1/m, world] */\n")
        self.assertEqual(self.violations(), [])

    def test_finds_an_unknown_key(self):
        self.write("freepath/base/a.h", "\n/// Unbiased [Kutz17, Eq. 2; Nobody99].\n")
        self.assert_one("freepath/base/a.h:2:", "[Nobody99]")

    def test_finds_an_unknown_key_broken_over_two_lines(self):
        self.write("freepath/base/a.h", "int a;\n/// as shown in [Nobody99,\n/// Eq. 3].\n")
        self.assert_one("freepath/base/a.h:2:", "[Nobody99]")
        self.write("freepath/base/a.h", "int a;\n/// as shown in [Kutz17, Eq. 3;\n/// Nobody99].\n")
        self.assert_one("freepath/base/a.h:3:", "[Nobody99]")

    def test_looks_at_comments_only(self):
        self.write("freepath/base/a.h", 'auto a = table[Nobody99]; auto b = "// [Nobody98]";\n')
        self.assertEqual(self.violations(), [])

    def test_is_not_misled_by_digit_separators(self):
        self.write("freepath/base/a.h", "int a = 1'000;  // [Nobody99]\nint b = 2'000;\n")
        self.assert_one("[Nobody99]")

    def test_looks_at_the_documents_too(self):
        self.write("docs/equations.md", "See [Nobody99, p. 3].\n")
        self.assert_one("docs/equations.md:1:")

    def test_a_key_is_given_once(self):
        self.write("docs/references.bib", BIBLIOGRAPHY + BIBLIOGRAPHY.split("@book")[0])
        self.assert_one("docs/references.bib:7:", "twice")


class Program(Tree):
    def run_script(self):
        return subprocess.run([sys.executable, SCRIPT, self.root], capture_output=True, text=True,
                              check=False)

    def test_exit_status_tells(self):
        self.assertEqual(self.run_script().returncode, 0)
        self.write("freepath/base/a.h", '#include "freepath/media/field.h"\n')
        result = self.run_script()
        self.assertEqual(result.returncode, 1)
        self.assertIn("freepath/base/a.h:1:", result.stdout)


if __name__ == "__main__":
    unittest.main()
