"""The check of names finds types that are defined twice, and only those."""

import importlib.util
import sys
import tempfile
import unittest
from importlib.machinery import SourceFileLoader
from pathlib import Path

sys.dont_write_bytecode = True
SCRIPT = Path(__file__).resolve().parent / "check_names"
_loader = SourceFileLoader("check_names", str(SCRIPT))
names = importlib.util.module_from_spec(importlib.util.spec_from_loader("check_names", _loader))
_loader.exec_module(names)


class Tree(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def wrong(self):
        return names.check(self.root)[1]

    def test_finds_types_of_two_files(self):
        self.write("freepath/a/a.h", "namespace freepath {\nstruct Range { int i; };\n}\n")
        self.write("freepath/b/b.cpp", "namespace freepath {\nclass Range final : Base {};\n}\n")
        self.assertEqual(self.wrong(), [
            "freepath/a/a.h:2: freepath::Range is also defined at freepath/b/b.cpp:2"])

    def test_finds_types_of_nested_namespaces_and_templates(self):
        self.write("freepath/a.h", "namespace freepath::x {\ntemplate <class T> struct P {};\n}")
        self.write("apps/a.h", "namespace freepath { namespace x {\nenum class P : int { kA };\n}}")
        self.assertEqual(len(self.wrong()), 1)

    def test_programs_may_use_a_name_of_their_own_again(self):
        text = "namespace freepath {\nstruct Options {};\n}\n"
        self.write("tests/a/a.cpp", text)
        self.write("tests/b/b.cpp", text)
        self.write("bench/b.cpp", text)
        self.assertEqual(self.wrong(), [])
        self.write("freepath/a.h", text)
        self.assertEqual(len(self.wrong()), 3)

    def test_leaves_the_rest_alone(self):
        self.write("freepath/a.cpp", """
namespace freepath {
struct Declared;
// struct Commented {};
const char* text = "struct Quoted {";
class Outer { struct Inner {}; };
class Other { struct Inner {}; };
namespace { struct Own {}; }
Declared make() { return {}; }
template <> struct Hash<Declared> {};
template <> struct Hash<Outer> {};
struct Outer* find(int i) { return nullptr; }
}
namespace other { struct Outer {}; }
""")
        self.write("freepath/b.cpp", "namespace freepath {\nnamespace { struct Own {}; }\n}")
        self.assertEqual(self.wrong(), [])


if __name__ == "__main__":
    unittest.main()
