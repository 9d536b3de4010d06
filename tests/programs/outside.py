#!/usr/bin/env python3
"""Programs of others, from the sources of Debian's packages, run on trax-sim as on the host: the same standard output,
exit status and files.

  outside.py --build build --work DIR [--only NAME,...] [--engine fast] [--speed]

Run on request: it fetches some 10 MB with apt-get, which it gives a list of sources of its own. DIR keeps what was
fetched and built. The sources are unchanged: each program is built as its authors say, but with another CC, or with the
toolchain file for CMake. Exit status: 0 if all programs agree. --speed: instead, the cycles of the first case of each
program for many threads, on one TP and on its chip."""

import argparse
import glob
import hashlib
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import time

SOURCES = "".join(f"deb-src http://deb.debian.org/debian {name} main\n" for name in ("bookworm", "trixie"))
CC = "CC={cc}"


class Program:
    """source: Debian's package, of bookworm or of the release after a slash. build: commands in the source's folder, or
    None for CMake. binary: what they make.
    cases: arguments; files: made in the folder of each run before it, by name (bytes), or copied from the source
    ("name": path). noise: what depends on the time in standard output. chip: options of trax-sim for many threads;
    options: others. flags: further ones of our compiler."""

    def __init__(self, name, source, binary, cases, build=None, cmake=(), files=None, noise=rb"(?!)", target="all",
                 chip=(), options=(), flags=""):
        self.name, self.source, self.binary, self.cases = name, source, binary, cases
        self.build, self.cmake = build, cmake
        self.files, self.noise, self.target, self.chip = files or {}, noise, target, chip
        self.options, self.flags = options, flags


class Case:
    def __init__(self, arguments, stdin=b""):
        self.arguments, self.stdin = arguments, stdin


def text(lines):
    return "".join(f"line {i} of {lines}: {i * i % 1009} {'abc' * (i % 7)}\n" for i in range(lines)).encode()


JSON = b'{"name": "trax", "list": [1, 2.5, -3e10, true, false, null, "\\u00e9\\n"], "nested": {"a": {"b": [[], {}]}}}\n'
LUA = b"""local function fib(n) return n < 2 and n or fib(n - 1) + fib(n - 2) end
print(arg[0], #arg, arg[1], fib(15))
for line in io.lines("data.txt") do if line:find("99") then io.write(line:upper(), "\\n") end end
local f = assert(io.open("out.txt", "w")); f:write(string.format("%5.2f|%q|%x\\n", math.pi, "a\\nb", 255)); f:close()
print(io.open("out.txt"):read("a"), select(2, io.open("missing.txt")))
local words = {} for w in io.read("a"):gmatch("%a+") do words[#words + 1] = w end
table.sort(words) print(table.concat(words, ","))
print(pcall(error, {1}), os.time{year=2024, month=2, day=29, hour=12}, string.rep("x", 3, "-"))
os.rename("out.txt", "renamed.txt") os.exit(7)
"""
AWK = b"""BEGIN { FS = "[ ,.]+"; srand(3) }
{ for (i = 1; i <= NF; i++) words[tolower($i)]++ }
/[aeiou][0-9]/ { matched++ }
END { for (w in words) if (words[w] > best) best = words[w]
  print NR, best, matched + 0, substr("abcdef", 2, 3), index("foobar", "bar"), toupper("x"), length(words)
  text = "foo boo"; print gsub(/o+/, "0", text), text, sprintf("%05.1f|%-4s|%c", 3.14159, "ab", 65)
  print match("xxabbb", /ab+/), RSTART, RLENGTH
  n = split("c,a,b", part, ","); print n, part[1], part[3], exp(1), sin(1), int(-3.7), 2 ^ 10, 1e6, 0.1 + 0.2 }
"""
JAVASCRIPT = b"""function sieve(n) { var p = [], c = []; for (var i = 2; i < n; i++) {
  if (!c[i]) { p.push(i); for (var j = i * i; j < n; j += i) c[j] = 1 } } return p }
print(sieve(60).join(' '), JSON.stringify({a: [1, 2, {b: 0.1 + 0.2}], s: "\\u00e9"}),
  (1e21).toString(), Math.sqrt(2), parseFloat("1.5e-7"));
print("a-b-c".replace(/-(.)/g, function (m, x) { return x.toUpperCase() }), [3, 1, 2].sort(),
  scriptArgs.length, new Date(0).toISOString());
try { null.x } catch (e) { print(e) }
"""
SCRIPT = b"""const fib = n => n < 2 ? n : fib(n - 1) + fib(n - 2);
class Heap {
  #items = [];
  push(x) { this.#items.push(x); this.#items.sort((a, b) => b - a) }
  pop() { return this.#items.pop() }
}
function* primes(n) {
  const c = new Uint8Array(n);
  for (let i = 2; i < n; i++) if (!c[i]) { yield i; for (let j = i * i; j < n; j += i) c[j] = 1 }
}
const heap = new Heap();
for (let i = 0; i < 200; i++) heap.push(i * 7919 % 211);
console.log(fib(15), heap.pop(), heap.pop(), [...primes(200)].at(-1), 2n ** 100n, (123456789n * 9876543n).toString(36));
const words = new Map();
for (const w of "the quick brown fox jumps over the lazy dog the end".split(" ")) words.set(w, (words.get(w) ?? 0) + 1);
console.log(JSON.stringify([...words].sort()), "a1b22c333".replace(/[0-9]+/g, m => `<${m.length}>`),
            /(?<y>\\d{4})-(?<m>\\d\\d)/u.exec("on 2024-02-29").groups.y);
console.log(0.1 + 0.2, (1 / 3).toFixed(20), 1e21 + 1, Math.hypot(3, 4), Math.sin(1),
            new Date(86400000 * 365.25).toISOString(), "\\u00e9\\u{1F600}".length);
const m = [];
for (let i = 0; i < 12; i++) { m[i] = []; for (let j = 0; j < 12; j++) m[i][j] = Math.fround(1 / (i + j + 1)) }
const product = m.map(r => m[0].map((_, j) => r.reduce((s, x, k) => s + x * m[k][j], 0)));
console.log(product[5][7], product[11][11]);
try { null.x } catch (e) { console.log(e instanceof TypeError, e.message) }
const file = std.open("out.txt", "w");
file.puts("one\\ntwo\\n");
file.close();
console.log(std.loadFile("out.txt").length, os.readdir(".")[0].sort().join());
Promise.all([1, Promise.resolve(2), new Promise(f => os.setTimeout(() => f(3), 10))])
  .then(v => { console.log(v, scriptArgs.length); std.exit(5) });
"""
SQL = b"""create table t(a integer primary key, b text, c real);
begin;
with recursive n(i) as (select 1 union all select i + 1 from n where i < 2000)
  insert into t select i, 'row ' || (i * 7919 % 2003), i / 7.0 from n;
commit;
create index tb on t(b);
select count(*), sum(a), round(avg(c), 6), min(b), max(b) from t;
update t set b = upper(b) where a % 3 = 0;
delete from t where a % 5 = 0;
begin; delete from t; rollback;
select substr(b, 1, 5), count(*) from t group by 1 order by 1 limit 5;
create table u as select a, b from t where a < 100;
select u.a, t.c from u join t using(a) where u.b like 'ROW%' order by t.c desc limit 4;
vacuum;
pragma integrity_check;
.tables
.schema t
.mode csv
select * from t where a between 10 and 14;
select json_object('x', 1, 'y', json_array(1, 2)), printf('%08.3f', 3.14159), date('2024-02-28', '+1 day');
.output out.csv
select a, c from t where a < 50;
.output
.dump u
"""
MARKDOWN = b"""# Title

Some *emphasis*, **strong**, `code` and [a link](http://example.org "t").

1. one
2. two
   - nested

> quote

| a | b |
| - | - |
| 1 | 2 |

```c
int main(void) { return 0; }
```
"""
BC = b"""scale = 30
4 * a(1)
e(1)
define f(n) { if (n <= 1) return (1); return (n * f(n - 1)); }
f(40)
2 ^ 200 % 97
sqrt(2)
for (i = 0; i < 5; i++) print i, " ", i / 7, "\\n"
obase = 16
255 * 255
"""
SCENE = b"""BEGIN_SCENE
  RESOLUTION 40 30
CAMERA
  ZOOM 1.0
  ASPECTRATIO 1.0
  ANTIALIASING 0
  RAYDEPTH 6
  CENTER  0.0 0.0 -5.0
  VIEWDIR 0.0 0.0 1.0
  UPDIR   0.0 1.0 0.0
END_CAMERA
DIRECTIONAL_LIGHT DIRECTION 1.0 -1.0 1.0 COLOR 1.0 1.0 1.0
SPHERE CENTER 0.0 0.0 2.0 RAD 1.2
  TEXTURE AMBIENT 0.1 DIFFUSE 0.6 SPECULAR 0.3 OPACITY 1.0 COLOR 1.0 0.4 0.2 TEXFUNC 0
SPHERE CENTER 1.2 0.8 1.0 RAD 0.5
  TEXTURE AMBIENT 0.1 DIFFUSE 0.9 SPECULAR 0.0 OPACITY 1.0 COLOR 0.2 0.4 1.0 TEXFUNC 0
PLANE CENTER 0.0 -1.5 0.0 NORMAL 0.0 1.0 0.0
  TEXTURE AMBIENT 0.1 DIFFUSE 0.9 SPECULAR 0.0 OPACITY 1.0 COLOR 0.8 0.8 0.8 TEXFUNC 0
END_SCENE
"""
DATA = {"data.txt": text(300), "small.txt": b"hello, world\n"}

CHIP = ("--config", "4x32", "--main-on", "0")
PROGRAMS = [
    Program("bzip2", "bzip2", "bzip2",
            [Case(["-k", "data.txt"]),
             Case(["-c"], text(50)),
             Case(["-tv", "data.txt"]),
             Case(["missing"])], [["make", CC, "bzip2"]], files=DATA),
    Program("lua", "lua5.4", "src/lua", [
        Case(["script.lua", "one", "two"], b"the quick brown fox"),
        Case(["-e", "print(2^53, 7 // 2, 1 / 3)"]),
        Case(["-"], b"print(#arg, ...)"),
        Case(["missing.lua"])], [["make", "-C", "src", CC + " -std=gnu99", "lua"]], files={**DATA, "script.lua": LUA}),
    Program("minigzip", "zlib", "minigzip",
            [Case(["data.txt"]), Case([], text(80)), Case(["-c", "small.txt"])],
            [["./configure", "--static"], ["make", CC, "minigzip"]], files=DATA),
    Program("xxhsum", "xxhash", "xxhsum",
            [Case(["data.txt", "small.txt"]),
             Case(["-H0"], b"abc"),
             Case(["-H2", "data.txt"]),
             Case(["missing"])], [["make", CC, "xxhsum"]], files=DATA),
    Program("mujs", "mujs", "build/release/mujs",
            [Case(["script.js", "one"]), Case(["-s", "missing.js"])],
            [["make", CC, "build/release/mujs", "HAVE_READLINE=no"]], files={"script.js": JAVASCRIPT}),
    Program("bc", "bc", "bc/bc", [
        Case(["-l", "sums.bc"]), Case([], b"1 + 2\n3 * 4 ^ 5\nquit\n")
    ], [["./configure", "--host=trax", "--build=x86_64-linux-gnu", CC], ["make", "-C", "lib"],
        # The files that the build makes by running the program itself are made by the host's.
        [
            "sh", "-c",
            "if [ {kind} = host ]; then make -C bc bc; else cp {host}/bc/libmath.h bc && make -C bc -o libmath.h bc; fi"
        ]], files={"sums.bc": BC + b"quit\n"}),
    Program("json_process", "jansson", "bin/json_process", [Case(["--env", "."], JSON)],
            cmake=["-DJANSSON_BUILD_DOCS=OFF"], target="json_process"),
    Program("cmark", "cmark", "src/cmark",
            [Case(["text.md"]),
             Case(["-t", "xml"], MARKDOWN),
             Case(["-t", "latex", "text.md", "text.md"])], cmake=["-DCMARK_TESTS=OFF",
                                                                  "-DCMARK_SHARED=OFF"], files={"text.md": MARKDOWN}),
    Program("md2html", "md4c", "md2html/md2html",
            [Case(["--github", "text.md"]), Case(["--output=out.html", "text.md"])], cmake=["-DBUILD_SHARED_LIBS=OFF"],
            files={"text.md": MARKDOWN}),
    Program("pbmtojbg", "jbigkit", "pbmtools/pbmtojbg",
            [Case(["picture.pbm", "picture.jbg"]),
             Case([], b"P1\n4 2\n0 1 0 1\n1 1 0 0\n")],
            [["make", CC, "-C", "libjbig"], ["make", CC, "-C", "pbmtools", "pbmtojbg"]],
            files={"picture.pbm": b"P1\n16 8\n" + b"0 1 1 0 " * 32}),
    Program("brotli", "brotli", "brotli", [
        Case(["-k", "data.txt"]), Case(["-c", "-q", "5"], text(60)),
        Case(["-d", "missing"])], cmake=[], target="brotli", files=DATA),
    Program("mawk", "mawk", "mawk", [
        Case(["-f", "script.awk", "data.txt"]),
        Case(["{ n += length($0) } END { print NR, n; printf \"%s %.3f %d\\n\", \"x\", n / 7, n % 5 }"], text(40)),
        Case(["BEGIN { while ((getline line < \"data.txt\") > 0) n++; print n; print n > \"out.txt\"; exit 3 }"])], [
            ["./configure", "--host=riscv32-unknown-elf", "--build=x86_64-linux-gnu", CC, "--with-builtin-regex"],
            ["make", "mawk"]], files={**DATA, "script.awk": AWK}),
    Program("gzip", "gzip", "gzip", [
        Case(["-kn9", "data.txt"]), Case(["-nc"], text(900)), Case(["-l", "data.txt.gz"]), Case(["-t", "small.txt"]),
        Case(["-dc", "data.txt.gz"]), Case(["-dv", "data.txt.gz"], b"y\n"), Case(["-rkn", "tree", "small.txt"]),
        Case(["-tr", "."]), Case(["-dfr", "tree"]), Case(["tree"]), Case(["-r", "missing"])], [
            ["./configure", "--host=riscv32-unknown-elf", "--build=x86_64-linux-gnu", CC], ["make"]],
            files={**DATA, "tree/a.txt": text(20), "tree/b/c/d.txt": text(30), "tree/b/e": b"e"}),
    # Its own VFS and its shell, which makes paths absolute. It needs tclsh.
    Program("sqlite3", "sqlite3", "sqlite3", [
        Case(["test.db"], SQL), Case(["test.db", "select count(*), sum(c) from t; pragma journal_mode;"]),
        Case(["-json", "test.db", "select a, b from t limit 3"]), Case(["test.db", "select none"])], [
            ["./configure", "--host=riscv32-unknown-elf", "--build=x86_64-linux-gnu", "--disable-tcl",
             "--disable-threadsafe", "--disable-load-extension", "--disable-readline", "--disable-shared", CC,
             "CFLAGS=-O1"], ["make", "sqlite3"]], options=("--dir", ".::/")),
    Program("quickjs", "quickjs/trixie", "qjs", [
        Case(["--std", "script.js", "one"]), Case(["-e", "print([1,2,3].map(x => x ** 2), typeof std)"]),
        Case(["missing.js"])], [["make", CC, "qjs", "CROSS_PREFIX={prefix}"]], files={"script.js": SCRIPT},
            flags=" -mstack-size=1024k"),
    # --- renderers ---
    Program("tachyon", "tachyon", "compile/linux/tachyon", [
        Case(["scene.dat", "-format", "PPM", "-o", "out.ppm"]),
        Case(["scene.dat", "-format", "TARGA", "-o", "out.tga", "-res", "32", "24"])], [[
            "make", "-C", "unix", "all", "ARCH=linux", CC, "CFLAGS=-O2 -DBsd", "LIBS=-L. -ltachyon -lm", "AR=ar",
            "ARFLAGS=r", "STRIP=true", "RANLIB=ranlib"]], files={"scene.dat": SCENE},
            noise=rb"\s*Rendering Progress:.*?complete *\r?|[0-9.]+ seconds"),
    # --- written for OpenMP ---
    Program("tachyon-openmp", "tachyon", "compile/linux/tachyon", [
        Case(["scene.dat", "-format", "PPM", "-o", "out.ppm", "-res", "64", "48"])], [[
            "make", "-C", "unix", "all", "ARCH=linux", CC, "CFLAGS=-O2 -DBsd -fopenmp",
            "LIBS=-fopenmp -L. -ltachyon -lm", "AR=ar", "ARFLAGS=r", "STRIP=true", "RANLIB=ranlib"]],
            files={"scene.dat": SCENE}, noise=rb"\s*Rendering Progress:.*?complete *\r?|[0-9.]+ seconds|.*CPU.*\n",
            chip=CHIP),
    Program("mksary-openmp", "libdivsufsort", "examples/mksary", [
        Case(["data.txt", "out.sa"]),
        Case(["missing", "out.sa"])], cmake=["-DBUILD_SHARED_LIBS=OFF", "-DUSE_OPENMP=ON"], target="mksary",
            files=DATA, noise=rb"[0-9.]+ sec", chip=CHIP),
    Program("bwt-openmp", "libdivsufsort", "examples/bwt", [
        Case(["small.txt", "out.bwt"]),
        Case(["-b1", "data.txt", "out.bwt"])], cmake=["-DBUILD_SHARED_LIBS=OFF", "-DUSE_OPENMP=ON"], target="bwt",
            files=DATA, noise=rb"[0-9.]+ sec", chip=CHIP),
    Program("soxr-openmp", "libsoxr", "examples/3-options-input-fn", [
        Case(["6", "4", "64", "3", "11", "0"], bytes(i * i % 251 for i in range(64 * 2 * 100)))],
            cmake=["-DBUILD_SHARED_LIBS=OFF", "-DBUILD_TESTS=OFF", "-DWITH_OPENMP=ON", "-DWITH_CR32S=OFF",
                   "-DWITH_CR64S=OFF", "-DBUILD_EXAMPLES=ON"],
            target="3-options-input-fn", chip=CHIP),
    Program("suftest-openmp", "libdivsufsort", "examples/suftest", [Case(["small.txt"])],
            cmake=["-DBUILD_SHARED_LIBS=OFF", "-DUSE_OPENMP=ON"], target="suftest", files=DATA,
            noise=rb"[0-9.]+ sec", chip=CHIP),
    *(Program(f"{name}-openmp", "libb2", name, [Case([])], [
        ["sh", "-c", "touch src/config.h"],  # what configure makes is not needed
        ["sh", "-c", "{cc} -O2 -std=gnu99 -fopenmp -DSUFFIX= -Isrc -o " + f"{name} src/{name}.c src/{name[:8]}.c "
         f"src/{name[:7]}-ref.c"]], chip=CHIP) for name in ("blake2sp-test", "blake2bp-test")),
    Program(
        "potrace", "potrace", "src/potrace",
        [Case(["-s", "picture.pbm", "-o", "out.svg"]),
         Case(["-b", "pgm", "picture.pbm", "-o", "out.pgm"])],
        [["./configure", "--host=riscv32-unknown-elf", "--build=x86_64-linux-gnu", CC, "--disable-zlib"],
         ["make", "-C", "src", "potrace"]], files={
             "picture.pbm": b"P1\n24 24\n" + b"".join(b"1 " if (x - 12)**2 + (y - 12)**2 < 100 else b"0 "
                                                      for y in range(24) for x in range(24))}),
    Program("graph", "plotutils", "graph/graph", [
        Case([
            "-T", "pnm", "-C", "--bitmap-size", "160x120", "-m", "2", "-S", "16", "0.06", "-q", "0.6", "-W", "0.02",
            "-X", "x", "-L", "Title \\*G", "points.txt"]),
        Case(["-T", "gif", "--bitmap-size", "120x90", "-l", "y", "-I", "e"], b"1 2 0.5  2 40 3  3 900 50  4 7 1\n"),
        Case(["-T", "svg", "-S", "4", "-B", "points.txt"]),
        Case(["-T", "meta", "missing"])], [[
            "./configure", "--host=riscv32-unknown-elf", "--build=x86_64-linux-gnu", CC, "--without-x",
            "--without-libpng", "--disable-shared"], *(["make", "-C", folder]
                                                       for folder in ("lib", "libxmi", "libplot", "graph"))],
            files={"points.txt": "".join(f"{i} {i * i % 37}\n" for i in range(41)).encode()}), ]


def run(command, cwd, log, env=None):
    with open(log, "ab") as file:
        file.write((" ".join(map(str, command)) + "\n").encode())
        file.flush()
        if subprocess.run(command, cwd=cwd, stdout=file, stderr=file, stdin=subprocess.DEVNULL, env=env,
                          check=False).returncode:
            raise RuntimeError(f"{command[0]} failed: {log}")


class Workshop:
    def __init__(self, build, work, engine):
        self.build, self.work, self.engine = build, work, engine
        self.flags = "--target=trax -mstack=global -mstack-size=256k"
        self.compilers = {"host": "cc", "trax": f"{build}/bin/clang {self.flags}"}

    def apt(self, *arguments, cwd=None):
        apt = self.work / "apt"
        for folder in ("lists/partial", "cache/archives/partial"):
            (apt / folder).mkdir(parents=True, exist_ok=True)
        (apt / "sources.list").write_text(SOURCES)
        run(["apt-get", "-q", "-o", f"Dir::Etc::SourceList={apt}/sources.list", "-o", "Dir::Etc::SourceParts=/dev/null",
             "-o",
             f"Dir::State::Lists={apt}/lists", "-o", f"Dir::Cache={apt}/cache", "-o", "APT::Sandbox::User=root",
             *arguments], cwd or apt,
            self.work / "apt.log")

    def fetch(self, package):
        """The folder of the upstream source of a package, unpacked."""
        package, _, release = package.partition("/")
        place = self.work / "sources" / package
        if not (place / "unpacked").exists():
            shutil.rmtree(place, ignore_errors=True)
            place.mkdir(parents=True)
            self.apt("source", "--download-only", "--tar-only", f"{package}/{release or 'bookworm'}", cwd=place)
            (place / "unpacked").mkdir()
            archive = [name for name in glob.glob(f"{place}/*.orig.tar.*") if not name.endswith(".asc")]
            run(["tar", "-C", place / "unpacked", "--strip-components=1", "-xf", archive[0]], place,
                self.work / "apt.log")
        return place / "unpacked"

    def make(self, program, kind):
        """Builds the program for the host or for trax; its path."""
        source = self.fetch(program.source)
        place = self.work / kind / program.name
        binary = place / ("build" if program.build is None else "source") / program.binary
        log = self.work / kind / f"{program.name}.log"
        elf = pathlib.Path(f"{binary}.elf")
        if not binary.exists() and not elf.exists():
            shutil.rmtree(place, ignore_errors=True)
            shutil.copytree(source, place / "source", symlinks=True)
            log.unlink(missing_ok=True)
            compiler = self.compilers[kind] + (program.flags if kind == "trax" else "")
            if program.build is None:
                toolchain = [f"-DCMAKE_TOOLCHAIN_FILE={self.build}/lib/trax/trax-toolchain.cmake",
                             f"-DCMAKE_C_FLAGS={self.flags}"]
                run(["cmake", "-S", place / "source", "-B", place / "build", "-DCMAKE_BUILD_TYPE=Release",
                     *program.cmake,
                     *(toolchain if kind == "trax" else [])], place, log)
                run(["cmake", "--build", place / "build", "--target", program.target], place, log)
            for command in program.build or []:
                words = [
                    word.format(cc=compiler, kind=kind, prefix="trax-" if kind == "trax" else "",
                                host=self.work / "host" / program.name / "source")
                    for word in command if kind == "trax" or not word.startswith(("--host", "--build"))]
                run(words, place / "source", log, {**os.environ, "CC": compiler})
        return elf if elf.exists() else binary

    def cases(self, program, kind):
        """Returns the output of each case, its status, its files and its errors."""
        binary, results = self.make(program, kind), []
        place = self.work / "run" / kind / program.name
        shutil.rmtree(place, ignore_errors=True)
        place.mkdir(parents=True)
        for name, contents in program.files.items():
            (place / name).parent.mkdir(parents=True, exist_ok=True)
            (place / name).write_bytes(contents if isinstance(contents, bytes) else (self.fetch(program.source) /
                                                                                     contents).read_bytes())
        for case in program.cases:
            command = [binary, *case.arguments]
            if kind == "trax":
                command = [self.build / "bin" / "trax-sim", "--engine", self.engine, "--quiet", *program.chip,
                           "--dir", ".", *program.options, *command]
            done = subprocess.run(command, cwd=place, input=case.stdin, capture_output=True, check=False, timeout=1200,
                                  env={"PATH": os.environ["PATH"], "TZ": "UTC", "LC_ALL": "C"})
            files = {
                str(path.relative_to(place)): hashlib.sha256(path.read_bytes()).hexdigest()
                for path in sorted(place.rglob("*")) if path.is_file()}
            results.append((re.sub(program.noise, b"", done.stdout), done.returncode, files, done.stderr))
        return results


def speed(shop, program):
    """A row of a table: cycles of the whole program on one TP, and on the chip."""
    binary, cycles = shop.make(program, "trax"), []
    place = shop.work / "speed" / program.name
    for chip in ((), program.chip):
        shutil.rmtree(place, ignore_errors=True)
        place.mkdir(parents=True)
        for name, contents in program.files.items():
            (place / name).write_bytes(contents)
        subprocess.run([shop.build / "bin" / "trax-sim", "--quiet", "--stats", "stats.json", *chip, "--dir", ".",
                        binary, *program.cases[0].arguments], cwd=place, input=program.cases[0].stdin,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=True)
        cycles.append(json.loads((place / "stats.json").read_text())["cycles"])
    return f"| {program.name} | {cycles[0]:,} | {cycles[1]:,} | {cycles[0] / cycles[1]:.1f} |"


def compare(shop, program):
    """Returns the differences, a line each, and the seconds that the program took."""
    begun, differences = time.monotonic(), []
    try:
        host, trax = shop.cases(program, "host"), shop.cases(program, "trax")
    except (RuntimeError, subprocess.TimeoutExpired, IndexError, OSError) as error:
        return [str(error)], 0
    for case, ours, theirs in zip(program.cases, trax, host):
        for what, a, b in zip(("standard output", "exit status", "files"), ours, theirs):
            if a != b:
                differences.append(
                    f"{case.arguments}: {what}: {str(a)[-300:]} instead of {str(b)[-300:]}; "
                    f"{ours[3].decode(errors='replace')[:400]}"
                )
    return differences, time.monotonic() - begun


def main():
    parser = argparse.ArgumentParser(description="Run programs of others on trax-sim and on the host.")
    parser.add_argument("--build", type=pathlib.Path, required=True)
    parser.add_argument("--work", type=pathlib.Path, required=True)
    parser.add_argument("--only", default="")
    parser.add_argument("--engine", default="functional")
    parser.add_argument("--speed", action="store_true")
    options = parser.parse_args()
    shop = Workshop(options.build.resolve(), options.work.resolve(), options.engine)
    chosen = [program for program in PROGRAMS if not options.only or program.name in options.only.split(",")]
    shop.work.mkdir(parents=True, exist_ok=True)
    if any(not (shop.work / "sources" / program.source.partition("/")[0] / "unpacked").exists() for program in chosen):
        shop.apt("update")
    failed = 0
    if options.speed:
        for program in chosen:
            if program.chip:
                try:
                    print(speed(shop, program), flush=True)
                except subprocess.CalledProcessError:
                    print(f"| {program.name} | - | - | it needs its threads |", flush=True)
        return
    for program in chosen:
        differences, seconds = compare(shop, program)
        failed += bool(differences)
        print(f"{'FAILED' if differences else 'passed'} {program.name}: {len(program.cases)} runs in {seconds:.1f} s",
              flush=True)
        for line in differences:
            print(f"  {line}")
    print(f"{len(chosen) - failed} passed, {failed} failed")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
