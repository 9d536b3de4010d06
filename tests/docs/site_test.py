"""The pages as a site, docs/site/make.py: site_test.py SOURCE

The site is built; mkdocs has no warning, every link and picture of the finished pages leads somewhere, every page of
docs/index.md stands in the left column, and files of the sources are copied or led to a repository. What is broken on
purpose is noticed. Skipped without Debian's packages mkdocs and mkdocs-material."""

import os
import pathlib
import subprocess
import sys
import tempfile

SOURCE = pathlib.Path(sys.argv[1]).resolve()
MAKE = SOURCE / "docs/site/make.py"
sys.path.insert(0, str(MAKE.parent))
import make  # noqa: E402
from blocks import pages as every_page  # noqa: E402

RENDERER = """#!/bin/sh
echo run >> runs
while [ $# -gt 0 ]; do [ "$1" = --explore ] && echo "<p>A page</p>" > "$2"; shift; done
"""


def check(condition, message):
    if not condition:
        print(message)
    return not condition


def broken(folder):
    """Pages with each fault that `faults` must find."""
    folder.mkdir()
    (folder / "a.html").write_text('<p id="here"><a href="none.html">x</a><a href="b.html#none">x</a>'
                                   '<a href="b.html#there">x</a><a href="#here">x</a><img src="none.png"></p>')
    (folder / "b.html").write_text('<p id="there"></p>')
    return [fault.split(": ", 1)[1] for fault in make.faults(folder)]


def check_runs(folder):
    """The commands with --explore run once, and the page leads to what they wrote."""
    (folder / "bin").mkdir(parents=True)
    (folder / "bin/trax-render").write_text(RENDERER)
    (folder / "bin/trax-render").chmod(0o755)
    text = "```sh long\ntrax-render a.obj -o a.png\ntrax-render a.obj \\\n  --explore a.html\n```\n"
    results = [make.with_runs(text, folder / "docs", folder) for _ in range(2)]
    failed = check(results == [text + "\nThe pages that they wrote: [a.html](runs/a.html).\n"] * 2, f"runs: {results}")
    failed += check((folder / "site-runs/runs").read_text() == "run\n", "a run is made twice")
    return failed + check((folder / "docs/runs/a.html").exists(), "the page of a run is not copied")


def check_uncopied(folder):
    """A site that cannot be copied whole, as on a full disk, leaves the earlier one and gives one reason."""
    site, out = folder / "new", folder / "out/site"
    for path, text in ((site / "a.html", "new"), (out / "a.html", "earlier")):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    for name in ("b", "c"):
        os.mkfifo(site / name)  # no file, which is an error of each
    try:
        make.put(site, out)
        said = ""
    except make.Failure as failure:
        said = str(failure)
    left = [path.read_text() for path in out.parent.rglob("*") if path.is_file()]
    return (check(said.count("named pipe") == 1, f"two files that cannot be copied: {said or 'no failure'}") +
            check(left == ["earlier"] and list(out.parent.iterdir()) == [out], f"a failure left {left}"))


def main():
    if not make.is_installed():
        print("skipped: Debian's packages mkdocs and mkdocs-material are not installed")
        return 77
    failed = 0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        found = broken(folder / "broken")
        failed += check(set(make.pages()) == set(every_page(SOURCE)), "make.py and blocks.py differ in pages")
        failed += check_runs(folder / "runs")
        failed += check(found == ["none.html leads nowhere", "b.html#none: no such chapter", "none.png leads nowhere"],
                        f"broken pages: {found}")
        site = folder / "site"
        done = subprocess.run([sys.executable, "-B", MAKE, "-o", site], capture_output=True, text=True)
        failed += check(done.returncode == 0, f"make.py: status {done.returncode}\n{done.stdout}{done.stderr}")
        if failed:
            return 1
        pages = list(site.rglob("*.html"))
        failed += check(len(pages) == len(make.pages()) + 1, f"{len(pages)} pages of {len(make.pages())} and 404.html")
        column = make.Anchors((site / "docs/index.html").read_text())
        places = {str((site / "docs" / link.split("#")[0]).resolve().relative_to(site)) for link in column.links}
        for title, paths in make.columns((SOURCE / "docs/index.md").read_text()):
            for path in paths:
                failed += check(str(pathlib.Path(path).with_suffix(".html")) in places or path == "README.md",
                                f"{title}: {path} is not in the left column")
        failed += check((site / "LICENSE").read_bytes() == (SOURCE / "LICENSE").read_bytes(), "LICENSE is not copied")
        linked = make.Site(folder / "linked", "https://trax.invalid/blob")
        text = linked.relinked("README.md", "[x](LICENSE) `[y](LICENSE)`")
        failed += check(text == "[x](https://trax.invalid/blob/LICENSE) `[y](LICENSE)`", f"a link becomes {text}")
        # A folder that is not a site is not replaced, even if it contains a folder `search`.
        (folder / "mine/search").mkdir(parents=True)
        (folder / "mine/search/file").write_text("")
        for out in ("mine", "mine/search/file"):
            done = subprocess.run([sys.executable, "-B", MAKE, "-o", folder / out], capture_output=True, text=True)
            kept = done.returncode == 1 and "is not a site" in done.stderr and (folder / "mine/search/file").exists()
            failed += check(kept, f"{out} is replaced: {done.stderr}")
        failed += check_uncopied(folder / "uncopied")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
