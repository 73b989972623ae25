"""Types of 64-byte alignment are passed by reference: by value g++ prints a note (-Wpsabi) for each, which no flag makes an error."""
import pathlib
import re
import subprocess
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
ALIGNED = re.compile(r"\bstruct alignas\(64\) (\w+)")


def by_value(text, types):
    """Parameters of these types that are neither references nor pointers."""
    return re.findall(rf"[(,]\s*(?:const\s+)?(?:{'|'.join(types)})\s+\w+\s*[,)]", text)


class AlignedParameters(unittest.TestCase):
    def test_none_is_passed_by_value(self):
        listed = subprocess.run(["git", "ls-files", "-z", "*.cpp", "*.h"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
        texts = {path: (ROOT / path).read_text(encoding="utf-8") for path in filter(None, listed.split("\0")) if (ROOT / path).is_file()}
        types = sorted({name for text in texts.values() for name in ALIGNED.findall(text)})
        self.assertIn("SliceNode", types)
        self.assertEqual({path: found for path, text in texts.items() if (found := by_value(text, types))}, {})

    def test_a_parameter_by_value_is_found(self):
        self.assertEqual(len(by_value("[&](SliceNode node) {", ["SliceNode"])), 1)
        self.assertEqual(len(by_value("void f(int a, const SliceNode node);", ["SliceNode"])), 1)
        self.assertEqual(by_value("f(const SliceNode& node, SliceNode* other)", ["SliceNode"]), [])


if __name__ == "__main__":
    unittest.main()
