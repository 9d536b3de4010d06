#!/usr/bin/env python3
"""The pages as a site with search: make.py [-o FOLDER] [--repository URL] [--runs BUILD] [--serve PORT]

The site has README.md, the pages of docs/ and the others that they lead to. The left column follows docs/index.md: a
section for each of its chapters, and the page's own title for each page. It needs Debian's packages mkdocs and
mkdocs-material. Links to other files lead to --repository URL, the address below which GitHub or GitLab shows a file of
the sources. Without it the files are copied into the site, and links to folders are text. A broken link, or a warning
of mkdocs, is an error.

--runs BUILD also runs the commands of docs/gallery.md that write an explore page, by the programs of that build folder,
and adds their pages. --serve PORT serves the finished site on this host: the search needs a server."""

import argparse
import contextlib
import functools
import html.parser
import http.server
import json
import os
import pathlib
import re
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import urllib.parse

SOURCE = pathlib.Path(__file__).resolve().parents[2]
LINK = re.compile(r"(\]\()([^)\s#:]+)((?:#[^)\s]*)?\))")
OTHERS = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "tests/isa/README.md", "raytracer/evaluation/README.md")
RUNS = "docs/gallery.md"
SETTINGS = {
    "site_name": "trax", "use_directory_urls": False, "strict": True, "extra_css": ["docs/site/site.css"],
    "theme": {
        "name": "material", "font": False, "features": ["navigation.top"],
        "palette": [
            {"media": f"(prefers-color-scheme: {name})", "scheme": scheme, "primary": "blue grey",
             "toggle": {"icon": f"material/{icon}", "name": f"{other.capitalize()} colours"}}
            for name, scheme, icon, other in (("light", "default", "weather-night", "dark"),
                                              ("dark", "slate", "weather-sunny", "light"))
        ]
    },
    "plugins": ["search"],
}


class Failure(Exception):
    pass


def is_installed():
    """Whether mkdocs and its theme are here: the help lists the themes."""
    program = shutil.which("mkdocs")
    return bool(program) and "material" in subprocess.run([program, "build", "--help"], capture_output=True,
                                                          text=True).stdout


def pages():
    return [SOURCE / name for name in OTHERS] + sorted((SOURCE / "docs").rglob("*.md"))


# --- the left column ---


def links_of(text):
    """Paths of the pages in the tables of a part of docs/index.md, in their order."""
    rows = "\n".join(line for line in text.splitlines() if line.startswith("|"))
    return [path for path in re.findall(r"\]\(([^)#]+\.md)\)", rows)]


def columns(index):
    """(title, pages) of each section: what the first table alone names, and each chapter. A page stands once."""
    first, *chapters = re.split(r"^## ", index, flags=re.M)
    chapters = [(text.split("\n", 1)[0], links_of(text)) for text in chapters]
    known = {path for _, paths in chapters for path in paths}
    begin = [path for path in links_of(first) if path not in known]
    sections, seen = [], {"../README.md"}
    for title, paths in [("To begin", begin), *chapters]:
        paths = [path for path in dict.fromkeys(paths) if path not in seen]
        seen.update(paths)
        if paths:
            sections.append((title, [str(resolve("docs/index.md", path)) for path in paths]))
    return sections


def resolve(page, link):
    """The place in the sources that a link of a page leads to."""
    return (SOURCE / page).parent.joinpath(link).resolve().relative_to(SOURCE)


def navigation():
    sections = columns((SOURCE / "docs/index.md").read_text())
    listed = {"README.md", "docs/index.md", *(path for _, paths in sections for path in paths)}
    rest = [str(path.relative_to(SOURCE)) for path in pages() if str(path.relative_to(SOURCE)) not in listed]
    return [{"README": "README.md"}, {"All pages by task": "docs/index.md"},
            *({title: paths} for title, paths in sections), {"Also": rest}]


# --- pages as Python's Markdown reads them ---


def converted(text):
    """The same page for Python's Markdown: a block names only its language, a list has a blank line before it, and what
    belongs to an item is indented by four."""
    lines, inside, before = [], False, ""
    for line in text.split("\n"):
        if line.startswith("```"):
            word = line[3:].split()[:1]
            line = line if inside or not word else "```" + word[0]
            inside = not inside
        elif not inside:
            is_item = re.match(r"\s*(?:[-*]|\d+\.) ", line)
            if is_item and before.strip() and not re.match(r"\s*(?:[-*]|\d+\.) |\s", before):
                lines.append("")
            if re.match(r" {2,3}\S", line):
                line = "    " + line.lstrip()
        lines.append(line)
        before = line
    return "\n".join(lines)


class Site:
    def __init__(self, folder, repository):
        self.folder, self.repository = folder, repository
        self.pages = {str(path.relative_to(SOURCE)) for path in pages()}

    def relinked(self, name, text):
        """The page with its links to other files of the sources led to the repository, or to copies of them."""
        def lead(found):
            to = resolve(name, found[2])
            path = SOURCE / to
            if str(to) in self.pages or not path.exists():
                return found[0]
            if self.repository and path.suffix not in (".png", ".svg"):
                return found[1] + f"{self.repository}/{to}" + found[3]
            (self.folder / to).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(path, self.folder / to)
            return found[0]

        def name_folder(found):
            """A folder is shown by the repository alone: without one its link is text."""
            is_folder = not self.repository and (SOURCE / resolve(name, found[2])).is_dir()
            return found[1] if is_folder else found[0]

        text = re.sub(r"\[([^\[\]]*)\]\(([^)\s#:]+)\)", name_folder, text)
        parts = re.split(r"(^```.*?^```$|`[^`\n]*`)", text, flags=re.M | re.S)
        return "".join(part if part.startswith("`") else LINK.sub(lead, part) for part in parts)

    def write(self, runs):
        for path in pages():
            name = str(path.relative_to(SOURCE))
            text = path.read_text(encoding="utf-8")
            if name == RUNS and runs:
                text = with_runs(text, self.folder / "docs", runs)
            (self.folder / name).parent.mkdir(parents=True, exist_ok=True)
            (self.folder / name).write_text(converted(self.relinked(name, text)), encoding="utf-8")
        style = self.folder / "docs/site/site.css"
        style.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(SOURCE / "docs/site/site.css", style)


# --- pages of runs ---


def with_runs(text, folder, build):
    """The page with a link to each run's page below the command that writes it; the commands run in a folder of the
    build, in which the pages stay until the program is built anew."""
    made = build / "site-runs"
    made.mkdir(exist_ok=True)

    def run(found):
        names = []
        for line in re.sub(r"\\\n\s*", " ", found[1]).splitlines():
            words = shlex.split(line, comments=True)
            if words[:1] == ["cp"] or line.startswith("build/"):  # the meshes of the commands
                subprocess.run([words[0].replace("build", str(build), 1), *words[1:]], cwd=made, check=True)
            if "--explore" not in words:
                continue
            names.append(words[words.index("--explore") + 1])
            page, command, program = made / names[-1], made / f"{names[-1]}.command", build / "bin" / words[0]
            is_new = page.exists() and page.stat().st_mtime > program.stat().st_mtime
            if not is_new or not command.exists() or command.read_text() != line:
                print(f"site: {line}", flush=True)
                done = subprocess.run([program, *words[1:], "--quiet"], cwd=made)
                if done.returncode != 0:
                    raise Failure(f"a command of {RUNS} failed (status {done.returncode})")
                command.write_text(line)
            (folder / "runs").mkdir(parents=True, exist_ok=True)
            shutil.copy(page, folder / "runs")
        links = ", ".join(f"[{name}](runs/{name})" for name in names)
        return found[0] + (f"\nThe pages that they wrote: {links}.\n" if names else "")

    return re.sub(r"^```sh long\n(.*?)^```\n", run, text, flags=re.M | re.S)


# --- the finished site ---


class Anchors(html.parser.HTMLParser):
    """The names that links of a page may lead to, and its own links."""
    def __init__(self, text):
        super().__init__()
        self.names, self.links = set(), []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name in ("id", "name"):
                self.names.add(value)
            elif name in ("href", "src") and value and not re.match(r"[a-z]+:|//", value):
                self.links.append(value)


def faults(site):
    """Links of the finished pages that lead nowhere."""
    read = {path.resolve(): Anchors(path.read_text(encoding="utf-8")) for path in site.rglob("*.html")
            if path.parent.name != "runs" and path.name != "404.html"}
    for path, page in read.items():
        for link in page.links:
            to, anchor = (urllib.parse.unquote(part) for part in urllib.parse.urldefrag(link))
            target = (path.parent / to).resolve() if to else path
            target = target / "index.html" if target.is_dir() else target
            if not target.exists():
                yield f"{path.relative_to(site)}: {link} leads nowhere"
            elif anchor and target in read and anchor not in read[target].names:
                yield f"{path.relative_to(site)}: {link}: no such chapter"


def build(out, repository, runs):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        Site(folder / "pages", repository).write(runs)
        extensions = ["tables", "fenced_code", "sane_lists", {"toc": {"permalink": True, "slugify": "SLUG"}}]
        settings = {**SETTINGS, "docs_dir": "pages", "site_dir": str(folder / "site"), "nav": navigation(),
                    "markdown_extensions": [*extensions, {"codehilite": {"guess_lang": False}}]}
        if repository:
            settings["repo_url"] = repository
        # JSON is YAML; the function that makes anchors is a tag of YAML.
        text = json.dumps(settings, indent=1).replace('"SLUG"', "!!python/name:anchors.slug")
        (folder / "mkdocs.yml").write_text(text)
        environment = {**os.environ, "PYTHONPATH": str(SOURCE / "docs/site"), "PYTHONDONTWRITEBYTECODE": "1"}
        done = subprocess.run(["mkdocs", "build", "--config-file", "mkdocs.yml"], cwd=folder,
                              env=environment, stderr=subprocess.PIPE, text=True)
        if done.returncode != 0:
            said = "\n".join(line for line in done.stderr.splitlines() if not line.startswith("INFO"))
            raise Failure(f"mkdocs ended with status {done.returncode}:\n{said[-3000:]}")
        wrong = list(faults(folder / "site"))
        if wrong:
            raise Failure("\n".join(wrong))
        put(folder / "site", out)


def put(site, out):
    """Replaces `out` once the whole site is beside it: on a full disk the earlier one stays."""
    out.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=out.parent, prefix=f".{out.name}-") as name:
        beside = pathlib.Path(name)
        try:
            shutil.copytree(site, beside / "new")
        except shutil.Error as error:  # one triple for each file: source, target, reason
            raise Failure(f"{out}: {error.args[0][0][2]}") from error
        if out.exists():
            out.rename(beside / "old")
        (beside / "new").rename(out)


def is_replaceable(out):
    """Whether a folder is absent, empty or a site."""
    return not out.exists() or out.is_dir() and (not any(out.iterdir()) or (out / "search/search_index.json").exists())


def serve(folder, port):
    handler = functools.partial(http.server.SimpleHTTPRequestHandler, directory=folder)
    with http.server.ThreadingHTTPServer(("127.0.0.1", port), handler) as server:
        print(f"site: http://127.0.0.1:{port}/", flush=True)
        with contextlib.suppress(KeyboardInterrupt):
            server.serve_forever()


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("-o", "--output", type=pathlib.Path, default=SOURCE / "build/site",
                        help="the finished site (default build/site); what is there is replaced")
    parser.add_argument("--repository", metavar="URL", help="where other files of the sources are shown")
    parser.add_argument("--runs", type=pathlib.Path, metavar="BUILD", help="also the explore pages of docs/gallery.md")
    parser.add_argument("--serve", type=int, metavar="PORT", help="serve it on this host afterwards")
    options = parser.parse_args()
    if not is_installed():
        print("make.py: error: the site needs Debian's packages mkdocs and mkdocs-material", file=sys.stderr)
        return 1
    if not is_replaceable(options.output):
        print(f"make.py: error: {options.output} is not a site, and is not replaced", file=sys.stderr)
        return 1
    try:
        build(options.output.resolve(), options.repository and options.repository.rstrip("/"),
              options.runs and options.runs.resolve())
        print(f"site: {options.output}")
        if options.serve:
            serve(options.output, options.serve)
    except (Failure, OSError, subprocess.CalledProcessError) as failure:
        print(f"make.py: error: {failure}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:  # ends by the signal, so that a shell's loop ends, too
        print("make.py: interrupted", file=sys.stderr)
        signal.signal(signal.SIGINT, signal.SIG_DFL)
        os.kill(os.getpid(), signal.SIGINT)
    return 0


if __name__ == "__main__":
    sys.exit(main())
