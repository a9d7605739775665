"""What is said of Talus beside its sources: the version is that of CMake's project everywhere, and the citation file has
what a reader of CITATION.cff needs. ctest -L package"""
import pathlib
import re
import unittest

import yaml

ROOT = pathlib.Path(__file__).resolve().parents[2]


def text_of(name):
    return (ROOT / name).read_text(encoding="utf-8")


def project_version():
    return re.search(r"^project\(talus VERSION (\d+\.\d+\.\d+)", text_of("CMakeLists.txt"), re.MULTILINE).group(1)


class Metadata(unittest.TestCase):
    def test_the_citation_file(self):  # required: https://github.com/citation-file-format, schema 1.2.0
        citation = yaml.safe_load(text_of("CITATION.cff"))
        self.assertEqual(citation["cff-version"], "1.2.0")
        self.assertEqual(citation["type"], "software")
        self.assertEqual(citation["license"], "Apache-2.0")
        self.assertEqual(citation["version"], project_version())
        for key in ("message", "title", "abstract"):
            self.assertIsInstance(citation[key], str, key)
        for people in (citation["authors"], citation["references"][0]["authors"]):
            for person in people:
                self.assertTrue({"name"} == set(person) or {"family-names"} <= set(person), person)
        known = {"cff-version", "message", "type", "title", "abstract", "version", "license", "authors", "keywords",
                 "references", "date-released", "doi", "repository-code", "url"}
        self.assertEqual(set(citation) - known, set())

    def test_one_version(self):
        recipe = text_of("packaging/conda/meta.yaml")
        self.assertIn(f'{{% set version = "{project_version()}" %}}', recipe)
        plugin = ROOT / "tools/qgis/talus_qgis/metadata.txt"
        if plugin.exists():
            self.assertIn(f"\nversion={project_version()}\n", plugin.read_text(encoding="utf-8"))
        self.assertRegex(text_of("CHANGELOG.md"), rf"\n## {re.escape(project_version())}\b")

    def test_licences(self):  # https://reuse.software, 3.0
        self.assertEqual(text_of("LICENSES/Apache-2.0.txt"), text_of("LICENSE"))
        self.assertIn("\nFiles: *\n", text_of(".reuse/dep5"))
        self.assertIn("\nLicense: Apache-2.0\n", text_of(".reuse/dep5"))


if __name__ == "__main__":
    unittest.main()
