"""Links, pictures and paths of the manual, and the sections that the sources name, are there."""
import os
import re
import subprocess
import unittest
from urllib.parse import unquote

ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), "../.."))
FOLDERS = ("data", "docs", "include", "src", "tests", "tools")


def text_of(path):
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        return file.read()


def pages():
    docs = sorted("docs/" + name for name in os.listdir(os.path.join(ROOT, "docs")) if name.endswith(".md"))
    return docs + ["README.md", "CONTRIBUTING.md"]


def without_code(text):
    return re.sub(r"^```.*?^```$", "", text, flags=re.M | re.S)


def headings(path):
    """The titles of a page, without marks."""
    return [re.sub(r"[`*]", "", h).strip() for h in re.findall(r"^#+ (.*)$", without_code(text_of(path)), re.M)]


def anchor(title):
    """As GitHub makes it of a title."""
    title = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", title).lower()
    return re.sub(r"[^\w\- ]", "", title).replace(" ", "-")


def links(path):
    """Relative targets of a page, as (file, anchor)."""
    text = re.sub(r"`[^`\n]*`", "", without_code(text_of(path)))
    for target in re.findall(r"\]\(([^)\s]+)\)", text):
        if not re.match(r"[a-z]+:", target):
            name, _, section = unquote(target).partition("#")
            yield os.path.normpath(os.path.join(os.path.dirname(path), name)) if name else path, section


class Links(unittest.TestCase):
    def test_targets_are_there(self):
        """The file, and the section where one is named."""
        broken = []
        for page in pages():
            for path, section in links(page):
                if not os.path.exists(os.path.join(ROOT, path)):
                    broken += [f"{page}: {path}"]
                elif section and ("--" in section or section not in map(anchor, headings(path))):  # mkdocs makes - of --
                    broken.append(f"{page}: {path}#{section}")
        self.assertEqual(broken, [])

    def test_pictures_are_used(self):
        used = {path for page in pages() for path, _ in links(page)}
        self.assertEqual([name for name in sorted(os.listdir(os.path.join(ROOT, "docs/pictures"))) if "docs/pictures/" + name not in used], [])

    def test_paths_are_in_the_repository(self):
        """Paths below the folders of the repository that the pages name, in code and in text."""
        missing = []
        for page in pages():
            for path in re.findall(r"(?<![\w./-])((?:%s)/[\w./-]*[\w/])" % "|".join(FOLDERS), text_of(page)):
                placeholder = re.search(r"/[A-Z]{4,}\b|/NAME_", path)  # tests/cli/FILE.py
                if not placeholder and not os.path.exists(os.path.join(ROOT, path)):
                    missing.append(f"{page}: {path}")
        self.assertEqual(sorted(set(missing)), [])

    def test_sections_that_sources_name(self):
        """A comment or a message that cites docs/page.md, "Section" finds both."""
        sources = subprocess.run(["grep", "-rnoEI", r'docs/[a-z-]+\.md(#[a-z-]+|, \\?"[^"\\]+)?', "include", "src", "tests", "tools", "CMakeLists.txt",
                                  "--exclude-dir=__pycache__"], cwd=ROOT, capture_output=True, text=True).stdout.splitlines()
        wrong = []
        for line in sources:
            where, citation = line.rsplit(":", 1)
            page, _, section = citation.replace("\\", "").partition(', "')
            page = page.partition("#")[0]
            if "links_test" in where or "worked_examples" in where:
                continue
            if not os.path.exists(os.path.join(ROOT, page)):
                wrong.append(line)
            elif section and not any(section.lower() in h.lower() for h in headings(page)) and f"**{section}" not in text_of(page):
                wrong.append(line)
        self.assertEqual(wrong, [])


if __name__ == "__main__":
    unittest.main()
