"""The pages hang together: links_test.py SOURCE

- Every link leads to a file, every #anchor and every quoted chapter (`[isa.md](isa.md), "Order"`) to a heading of it.
- Every `docs/PAGE.md, "Chapter"` in the sources, too.
- `folder/file` is a file of the sources, `trax_name` a word of them.
- docs/index.md and README.md lead to every page, directly or by another page; docs/index.md names every page of docs/.
- A page begins with a title and a sentence, and has at most LINES lines besides generated lists; pages of results and
  GENERATED may have long tables.
- A page of results says once, with `*Measured with ...*`, which versions measured it: those that stand above its
  tables.
- What is code stands between backticks: an indented block has no kind, and no test runs it.
- VERSION has a chapter in CHANGELOG.md.
- Every picture in docs/ is shown by a page, is what its name says, and is small.

It also sees that it can fail."""

import pathlib
import re
import sys
import xml.dom.minidom

from blocks import kind, pages, read_blocks

LINES = 250
FOLDERS = ("emulator", "isa", "llvm-target", "raytracer", "runtime", "tests", "cmake")
PICTURE = 300_000  # bytes of a PNG
GENERATED = {
    "isa.md": "the manual", "isa-coverage.md": "the suite's cases", "timing-rules.md": "the rules of time",
    "trax-sim.md": "lists of options"
}
LINK = re.compile(r"!?\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s]+)\)")
QUOTED = re.compile(r"\]\(([^)\s#]+\.md)\)(?:,\s+|,? section )((?:\"[^\"]+\"(?:,? and |, )?)+)")
IN_SOURCES = re.compile(r"\bdocs/([\w/-]+\.md)\b(?:,[\s/*#]*\"([^\"]+)\")?")
FILE = re.compile(
    r"`(?:\./)?(\w[\w.+-]*(?:/[\w.+-]+)+\.(?:c|h|cpp|py|td|def|sh|cmake|json|cfg|md|patch|inc|txt))(?::\d+)?`")
NAME = re.compile(r"`(_*(?:trax|TRAX)_\w+)(?:\([^`]*\))?`")
OTHERS = ("docs/llvm-releases.md", )  # names files of LLVM
SOURCES = (".c", ".h", ".cpp", ".py", ".td", ".txt", ".in", ".sh", ".cmake", ".s", ".S", ".inc", ".def")


def without_code(text):
    """The same lines, with blocks and `code` emptied."""
    lines, inside = [], False
    for line in text.split("\n"):
        if line.startswith("```"):
            inside = not inside
            lines.append("")
        else:
            lines.append("" if inside else line)
    return re.sub(r"`[^`\n]*`", "``", "\n".join(lines))


def headings(text):
    found, inside = [], False
    for line in text.split("\n"):
        if line.startswith("```"):
            inside = not inside
        elif not inside and re.match(r"#+ ", line):
            found.append(line.lstrip("#").strip())
    return found


def slug(heading):
    plain = re.sub(r"[`*]", "", LINK.sub(r"\1", heading)).lower()
    return re.sub(r"[^\w\- ]", "", plain).replace(" ", "-")


def plain(heading):
    return re.sub(r"[`*]", "", heading)


def indented(lines):
    """Numbers of lines that begin a block by four blanks, but for what belongs to a list."""
    inside = listed = False
    before = ""
    for number, line in enumerate(lines, 1):
        if line.startswith("```"):
            inside = not inside
        elif not inside and line.strip():
            if not line.startswith(" "):
                listed = bool(re.match(r"([-*]|\d+\.) ", line))
            elif line.startswith("    ") and not listed and not before.startswith("    "):
                yield number
        before = line


class Pages:
    def __init__(self, source):
        self.source = pathlib.Path(source).resolve()
        self.texts = {page.resolve(): page.read_text(encoding="utf-8") for page in pages(self.source)}
        self.files = [
            f"/{path.relative_to(self.source)}" for folder in (*FOLDERS, "docs")
            for path in (self.source / folder).rglob("*") if path.is_file()
        ]
        self.words = {word for path, text in self.sources() for word in re.findall(r"\b_*(?:trax|TRAX)_\w+", text)}

    def name(self, page):
        return page.relative_to(self.source)

    def chapters(self, page):
        text = self.texts.get(page)
        return headings(text if text is not None else page.read_text(encoding="utf-8"))

    def links(self, page, text):
        """(wrong lines, pages and pictures it leads to)."""
        wrong, led = [], set()
        for found in LINK.finditer(without_code(text)):
            target, _, anchor = found[2].partition("#")
            if re.match(r"[a-z]+:", found[2]):
                continue
            to = (page.parent / target).resolve() if target else page
            if not to.exists():
                wrong.append(f"{self.name(page)}: {found[2]} leads nowhere")
                continue
            led.add(to)
            if anchor and anchor not in [slug(heading) for heading in self.chapters(to)]:
                wrong.append(f"{self.name(page)}: {found[2]}: no such chapter")
        blank = without_code(text)
        for found in QUOTED.finditer(re.sub(r"\n", " ", blank)):
            to = (page.parent / found[1]).resolve()
            for chapter in re.findall(r'"([^"]+)"', found[2]):
                if to.exists() and chapter not in map(plain, self.chapters(to)):
                    wrong.append(f"{self.name(page)}: {found[1]} has no chapter \"{chapter}\"")
        return wrong, led

    def named(self, page, text):
        """Files and names in a page that the sources lack. A word in capitals stands for another, out/ is the
        reader's."""
        wrong = []
        for found in () if str(self.name(page)) in OTHERS else FILE.finditer(text):
            if not re.search(r"\b[A-Z]{2,}\b", found[1]) and not found[1].startswith("out/") and not any(
                    name.endswith("/" + found[1]) for name in self.files):
                wrong.append(f"{self.name(page)}: there is no {found[1]}")
        return wrong + [
            f"{self.name(page)}: the sources have no {name}" for name in NAME.findall(text) if name not in self.words
        ]

    def versions(self, page, text):
        """What is wrong with what a page of results says of versions."""
        said = re.findall(r"^\*Measured with (.*)\*$", text, re.M)
        above = set(re.findall(r"trax (\d[\d.]*\d)", " ".join(re.findall(r"; measured with (.*):$", text, re.M))))
        if len(said) != 1 or above and set(re.findall(r"\d+\.\d+\.\d+", said[0])) != above:
            return [
                f"{self.name(page)}: does not say once, with *Measured with ...*, which versions measured it "
                f"({', '.join(sorted(above)) or 'the version'})"
            ]
        return []

    def form(self, page, text):
        name = self.name(page)
        lines = text.split("\n")
        wrong = [] if re.match(r"# \S", lines[0]) else [f"{name}: does not begin with a title"]
        first = next((line for line in lines[1:] if line.strip() and not line.startswith(("<", "!"))), "")
        if not re.match(r"[A-Z`\[*]", first):
            wrong.append(f"{name}: does not begin with a sentence that says what it is for")
        wrong += [f"{name}: line {line}: an indented block" for line in indented(lines)]
        count, generated = 0, False
        results = "results" in name.parts or page.name in GENERATED
        for line in lines:
            generated = (generated or
                         re.match(r"<!-- \S+.*: begin -->", line)) and not re.match(r"<!-- \S+.*: end -->", line)
            count += not generated and not (results and line.startswith("|"))
        count -= sum(
            block.count("\n") for words, block, _ in read_blocks(text) if kind(words, block) == "help" or results)
        if count > LINES and page.name not in GENERATED:
            wrong.append(f"{name}: has {count} lines; {LINES} is what one reads in ten minutes")
        for words, block, line in read_blocks(text) if page.name != "isa.md" else ():
            if kind(words, block) is None:
                wrong.append(f"{name}: line {line}: a block of \"{words}\" (tests/docs/blocks.py has the kinds)")
        return wrong

    def check(self):
        wrong, led = [], {}
        for page, text in self.texts.items():
            faults, led[page] = self.links(page, text)
            wrong += faults + self.form(page, text) + self.named(page, text)
            wrong += self.versions(page, text) if "results" in self.name(page).parts else []
        reached, todo = set(), [self.source / "README.md", self.source / "docs/index.md"]
        while todo:
            page = todo.pop()
            if page not in reached:
                reached.add(page)
                todo += led.get(page, ())
        index = led.get(self.source / "docs/index.md", set())
        for page in self.texts:
            if page not in reached:
                wrong.append(f"{self.name(page)}: neither README.md nor docs/index.md leads to it")
            elif page.is_relative_to(self.source / "docs") and page.name != "index.md" and page not in index:
                wrong.append(f"{self.name(page)}: is not in docs/index.md")
        version = (self.source / "VERSION").read_text().strip()
        if f"## {version}" not in self.texts.get(self.source / "CHANGELOG.md", ""):
            wrong.append(f"CHANGELOG.md: has no chapter {version}, the version of VERSION")
        shown = set().union(*led.values())
        for picture in sorted((self.source / "docs").rglob("*")):
            if picture.suffix in (".svg", ".png"):
                if picture not in shown:
                    wrong.append(f"{self.name(picture)}: no page shows it")
                wrong += self.picture(picture, picture.read_bytes())
        return wrong

    def picture(self, path, content):
        if path.suffix == ".png":
            if content[:8] != b"\x89PNG\r\n\x1a\n" or content[-8:-4] != b"IEND":
                return [f"{self.name(path)}: is no PNG"]
            return [f"{self.name(path)}: has {len(content)} bytes"] if len(content) > PICTURE else []
        try:
            xml.dom.minidom.parseString(content)
        except Exception as error:  # of expat
            return [f"{self.name(path)}: {error}"]
        return []

    def in_sources(self, path, text):
        wrong = []
        for found in IN_SOURCES.finditer(text):
            page = self.source / "docs" / found[1]
            chapter = found[2] and re.sub(r"\s*\n[\s/*#]*", " ", found[2])
            if not page.exists():
                wrong.append(f"{path}: there is no docs/{found[1]}")
            elif chapter and chapter not in map(plain, self.chapters(page)):
                wrong.append(f"{path}: docs/{found[1]} has no chapter \"{chapter}\"")
        return wrong

    def sources(self):
        for folder in FOLDERS:
            for path in sorted((self.source / folder).rglob("*")):
                if path.suffix in SOURCES and "fuzz-corpus" not in path.parts and path != pathlib.Path(
                        __file__).resolve():
                    yield path.relative_to(self.source), path.read_text(encoding="utf-8", errors="replace")

    def unnoticed(self):
        """What is broken on purpose, and not noticed."""
        page = self.source / "docs/index.md"
        for text in ("[x](none.md)", "[x](isa.md#none)", '[isa.md](isa.md), "No such chapter"',
                     "[x](../README.md#none)", "![x](none.svg)"):
            if not self.links(page, f"# T\n\nText {text}.\n")[0]:
                yield f"{text} is not noticed"
        for text in ("Text.\n", "# T\n\n| a |\n", "# T\n\nText.\n" + "x\n" * (LINES + 9),
                     "# T\n\nText.\n\n```\nls\n```\n", "# T\n\nText.\n\n    ls\n"):
            if not self.form(page, text):
                yield f"a page that begins with {text[:20]!r} is not noticed"
        for text in ("`emulator/none.c`", "`clang/TraxBuiltins.def`", "`trax_no_such_name`", "`trax_no_such_name(x)`"):
            if not self.named(page, text):
                yield f"{text} is not noticed"
        for text in ("", "*Measured with trax 0.1.0.*\n*Measured with trax 0.1.0.*\n",
                     "*Measured with trax 0.1.0.*\n\n`x`; measured with trax 0.2.0 (2026-01-01):\n"):
            if not self.versions(page, text):
                yield f"a page of results with {text!r} is not noticed"
        for text in ("docs/none.md", 'docs/isa.md, "No such chapter"'):
            if not self.in_sources("x.c", f"/* {text} */"):
                yield f"{text} is not noticed"
        for path, content in (("docs/x.png", b"GIF"), ("docs/x.svg", b"<svg>")):
            if not self.picture(self.source / path, content):
                yield f"a broken {path} is not noticed"


def main():
    every = Pages(sys.argv[1])
    wrong = every.check() + list(every.unnoticed())
    files = 0
    for path, text in every.sources():
        wrong += every.in_sources(path, text)
        files += 1
    for line in wrong:
        print(line)
    print(f"{len(every.texts)} pages, {files} sources, {len(wrong)} faults")
    return 1 if wrong or len(every.texts) < 20 or files < 500 else 0


if __name__ == "__main__":
    sys.exit(main())
