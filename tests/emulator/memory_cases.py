"""The cases of memory_test.py: a program with a function for each, which has one error of memory or none."""

import itertools

HEAD = """#include <malloc.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <trax.h>

#define CASE static __attribute__((noinline)) void
#define OPAQUE(p) __asm__ volatile("" : "+r"(p) : : "memory")
#define BARRIER __asm__ volatile("" ::: "memory")
typedef unsigned char byte;
typedef unsigned short half;
typedef unsigned word;
static volatile unsigned sink;
static volatile int at;
static void *volatile kept;
static void **volatile table, **volatile stale;
static _Thread_local void *own;
static char *volatile escaped;

__attribute__((noinline)) static void fill(void *memory, unsigned size) {
  for (unsigned i = 0; i < size; i++)
    ((volatile byte *)memory)[i] = (byte)(i + 1);
}
__attribute__((noinline)) static void *block(unsigned size) {
  void *memory = malloc(size);
  fill(memory, size);
  return memory;
}
"""

OUTSIDE = "an access outside of its object"
NOWHERE = "an access to memory that belongs to no object"
FREED = "an access to a freed block"
FRAME = "an access below the stack's frame"
BRANCH = "a branch depends on memory that was never written"
ADDRESS = "an address depends on memory that was never written"
OUTPUT = "output depends on memory that was never written"
TWICE = "a block is freed twice"
INVALID = "what is freed is not the beginning of a block"
LEAK = "a block is lost: no pointer to it is left, and it was not freed"

TYPES = {"byte": 1, "half": 2, "word": 4}
ACCESSES = {"load": "sink = p[i];", "store": "p[i] = p[i];"}  # the heap's lists and return addresses stay as they are


def bounds():
    """Accesses by an index: kind of memory x its size x type x access x side x distance; and the first and last
    element, which are right."""
    for (kind, sizes), (name, size), access in itertools.product(
            (("heap", (16, 20, 96, 4096)), ("global", (12, 32, 100)), ("stack", (12, 40, 100)),
             ("alloca", (12, 40, 100))), TYPES.items(),
            ACCESSES.values()):
        for total in sizes:
            count = total // size
            before = [] if kind == "global" else [-1, -3]
            for index in [0, count - 1, count, count + 1, count + 7, *before]:
                objects = ""
                if kind == "heap":
                    begin, end = f"volatile {name} *p = block({total}); void *q = (void *)p;", "free(q);"
                elif kind == "global":
                    begin, end = f"volatile {name} *p = OBJECT;", ""
                    objects = f"static {name} OBJECT[{count}], OBJECT_next[64 / sizeof({name})];"
                elif kind == "alloca":
                    begin, end = f"at = {total}; void *q = alloca(at); fill(q, {total}); volatile {name} *p = q;", ""
                else:
                    begin, end = f"{name} a[{count}]; fill(a, {total}); volatile {name} *p = a;", ""
                right = 0 <= index < count
                body = f"{begin} OPAQUE(p); at = {index}; int i = at; {access} {end}"
                yield objects, body, not right and OUTSIDE


def direct():
    """Accesses to global arrays without a pointer, as the compiler makes them."""
    for (name, size), access in itertools.product(TYPES.items(), ACCESSES.values()):
        for index in (0, 9, 10, 12):
            yield (f"volatile {name} OBJECT[10], OBJECT_next[64 / sizeof({name})];",
                   f"at = {index}; int i = at; {access.replace('p', 'OBJECT')}", index > 9 and OUTSIDE)


def lifetimes():
    for (name, _), access, again in itertools.product(TYPES.items(), ACCESSES.values(), ("", "void *r = block(24);")):
        release = "free(r);" if again else ""
        for freed in (True, False):
            first, last = ("free(q);", "") if freed else ("", "free(q);")
            yield "", (f"volatile {name} *p = block(24); void *q = (void *)p; OPAQUE(p); {first} {again} at = 1; "
                       f"int i = at; {access} {last} {release}"), freed and FREED
    yield "", ("char *p = block(20), *r = p, *q; OPAQUE(r); q = realloc(p, 2000); OPAQUE(q); sink = r[0]; "
               "free(q);"), FREED
    yield "", "char *p = block(20), *q = realloc(p, 2000); sink = q[19]; free(q);", None
    yield "", "char *p = block(200), *q = realloc(p, 8); sink = q[8]; free(q);", OUTSIDE
    for name, index in (("byte", 5), ("word", 2)):
        yield (f"static __attribute__((noinline)) void OBJECT(void) {{ volatile {name} a[8]; a[{index}] = 1; "
               f"escaped = (char *)&a[{index}]; }}", f"OBJECT(); sink = *({name} *)escaped;", FRAME)
        yield (f"static __attribute__((noinline)) void OBJECT(volatile {name} *a) {{ sink = a[{index}]; }}",
               f"volatile {name} a[8]; a[{index}] = 1; OBJECT(a);", None)


def never_written():
    uses = {BRANCH: "if (p[1] > 7) sink = 1;", ADDRESS: "sink = many[p[1]];", OUTPUT: "putchar_(p[1]);"}
    for (name, size), (finding, use), kind in itertools.product(TYPES.items(), uses.items(), ("heap", "stack")):
        if finding == ADDRESS and name != "byte":
            use = use.replace("p[1]", "p[1] & 255")
        for write in ("p[1] = 3;", "p[0] = 3;", f"memset(p, 1, {4 * size});"):
            if kind == "heap":
                begin, end = f"{name} *p = malloc({4 * size}), *q = p;", "free(q);"
            else:
                begin, end = f"{name} a[4], *p = a;", ""
            yield "", f"{begin} OPAQUE(p); {write} BARRIER; {use} {end}", (
                finding if "[0]" in write else None)
    # A copy and bits that do not matter are no uses.
    yield "", "word *p = malloc(8), a[2]; memcpy(a, p, 8); sink = a[0] & 0; free(p);", None
    # Of a word, the low byte is 5 and the rest unknown: k is a constant that the compiler does not know.
    for k, condition, decided in (
            (255, "(w & k) == 5", True), (511, "(w & k) == 5", False), (0xFFFFFF00, "(w | k) == k + 5", True),
            (0xFFFFFE00, "(w | k) == k + 5", False), (24, "(w << k) == 5u << 24", True),
            (23, "(w << k) == 5u << 23", False), (8, "(w >> k) == 7", False), (3, "((w + k) & 255) == 8", True),
            (3, "((w + k) & 256) == 0", False),
            (251, "((w + k) & 255) == 0", True), (6, "((w - k) & 255) == 255", True), (5, "w == k", False),
            (4, "w == k", True), (5, "w < k", True), (6, "w < k", False), (256, "((w * k) & 255) == 0", True),
            (3, "((w * k) & 255) == 15", True), (3, "((w * k) & 256) == 0", False), (5, "((w ^ k) & 255) == 0", True),
            (0, "(w & k) != 0", True), (1, "(w & 255) * k == 5", True), (1, "(int)w > (int)k", False),
            (1, "(w > k ? w : k) != 0", True), (0, "(w < k ? w : k) == 0", True),
            (255, "(w < k ? w : k) == 255", False)):
        # Each sum and product has only the bits that can change.
        yield "", (f"word *p = malloc(4); OPAQUE(p); *(byte *)p = 5; BARRIER; word w = *p, k = {k}; OPAQUE(k); "
                   f"OPAQUE(w); if ({condition}) sink = 1; free(p);"), not decided and BRANCH
    for k, decided in ((0, True), (255, False)):  # a carry out of unknown bits
        yield "", ("byte *p = calloc(4, 1), *q = malloc(1); OPAQUE(p); OPAQUE(q); *p = *q; BARRIER; "
                   f"word w = *(word *)p, k = {k}; OPAQUE(k); OPAQUE(w); if (w + k > 255) sink = 1; free(q); "
                   "free(p);"), not decided and BRANCH
    yield "", ("char *p = malloc(13); strcpy(p, \"twelve bytes\"); sink = strlen(p) + strcmp(p, \"twelve\"); "
               "free(p);"), None
    yield "", "char *p = malloc(6); OPAQUE(p); p[3] = 0; sink = strlen(p); free(p);", BRANCH
    yield "", "word *p = calloc(4, 4); if (p[2]) sink = 1; free(p);", None
    yield "", "signed char *p = malloc(4); OPAQUE(p); int s = p[1]; OPAQUE(s); if (s >> 8) sink = 1; free(p);", BRANCH
    # A byte of a pointer, which is the same in both, makes it no pointer to the other block.
    yield "", ("byte *a = aligned_alloc(256, 256), *b = aligned_alloc(256, 256); byte *volatile w = a; OPAQUE(b);"
               "*(volatile byte *)&w = (byte)(word)b; sink = w[0]; free(a); free(b);"), None
    yield "", "word *p = block(8); p = realloc(p, 16); OPAQUE(p); if (p[1] == 1) sink = 1; free(p);", None
    yield "", "word *p = block(20000); p = realloc(p, 40000); OPAQUE(p); if (p[3000] == 1) sink = 1; free(p);", None
    yield "", "word *p = block(8); p = realloc(p, 16); OPAQUE(p); if (p[3] == 1) sink = 1; free(p);", BRANCH
    for index, finding in (("n - 1", None), ("n", OUTSIDE)):
        yield "", ("byte *p = malloc(20); OPAQUE(p); unsigned n = malloc_usable_size(p); fill(p, n); "
                   f"sink = p[{index}]; free(p);"), finding


def leaks():
    yield "", "void *p = block(20); OPAQUE(p); sink = *(byte *)p;", LEAK
    yield "", "void *p = block(20); OPAQUE(p); free(p);", None
    yield "", "kept = block(24);", None
    yield "", "own = block(28);", None
    yield "", "table = malloc(8); table[0] = block(3); table[1] = NULL;", None
    yield "", "void **p = malloc(8); p[0] = NULL; p[1] = p; OPAQUE(p);", LEAK
    yield "", "char *p = block(40); escaped = p + 8; sink = 1;", None  # from its middle
    yield "", "void *p = block(5000); p = NULL; OPAQUE(p);", LEAK


def juliet():
    """The shapes of NIST's Juliet suite for C, with the right twin of each."""
    text = "\"0123456789\""
    # CWE-121, stack-based buffer overflow; CWE-122, heap-based.
    for room, wrong in ((10, True), (11, False)):
        for begin, end in ((f"_Alignas(4) char a[{room}]; char *p = a;", ""),
                           (f"char *p = malloc({room}), *q = p;", "free(q);")):
            for copy in (f"memcpy(p, {text}, 11);", f"strcpy(p, {text});", f"memmove(p, {text}, 11);",
                         f"strncpy(p, {text}, 11);", "p[0] = 0; strcat(p, \"01234\"); strcat(p, \"56789\");",
                         f"sprintf(p, \"%s\", {text});", f"for (int i = 0; i < 11; i++) p[i] = {text}[i];",
                         f"snprintf(p, 11, \"%s\", {text});"):
                yield "", f"{begin} OPAQUE(p); {copy} sink = p[9]; {end}", wrong and OUTSIDE
    for size, wrong in (("sizeof(int) / 2", True), ("sizeof(int)", False)):
        yield "", f"int *p = malloc(10 * {size}), *q = p; OPAQUE(p); for (int i = 0; i < 10; i++) p[i] = i; free(q);", (
            wrong and OUTSIDE)
    # CWE-124, underwrite; CWE-127, underread; CWE-126, overread.
    for first, wrong in ((-8, True), (0, False)):
        for begin, end in (("char a[40], *p = a;", ""), ("char *p = malloc(40), *q = p;", "free(q);")):
            yield "", f"{begin} fill(p, 40); OPAQUE(p); memset(p + {first}, 'C', 20); {end}", wrong and OUTSIDE
            yield "", (f"{begin} static char b[20]; fill(p, 40); OPAQUE(p); memcpy(b, p + {first}, 20); "
                       f"char *t = b; OPAQUE(t); {end}"), wrong and OUTSIDE
    for size, wrong in ((41, True), (40, False)):
        for begin, end in (("char a[40], *p = a;", ""), ("char *p = malloc(40), *q = p;", "free(q);")):
            yield "", (f"{begin} char b[48]; fill(p, 40); OPAQUE(p); memcpy(b, p, {size}); char *t = b; "
                       f"OPAQUE(t); {end}"), wrong and OUTSIDE
            yield "", (f"{begin} fill(p, 40); OPAQUE(p); unsigned s = 0; for (volatile int i = 0; i < {size}; i++) "
                       f"s += p[i]; sink = s; {end}"), wrong and OUTSIDE
    # CWE-401, a leak on one path; CWE-416, use after free; CWE-457, a variable without a value.
    for flag, wrong in ((1, True), (0, False)):
        yield "", f"char *p = block(100); volatile int fails = {flag}; if (fails) return; free(p);", wrong and LEAK
        yield "", (f"char *p = block(100), *q = p; OPAQUE(p); volatile int early = {flag}; if (early) free(q); "
                   "sink = p[3]; if (!early) free(q);"), wrong and FREED
        yield "", (f"int value[1], *p = value; OPAQUE(p); volatile int none = {flag}; if (!none) *p = 4; "
                   "BARRIER; printf(\"%d\\n\", *p);"), wrong and BRANCH


def fatal():
    """Errors that end the program: the heap complains, or the machine faults. CWE-415, CWE-590, CWE-761."""
    yield "char *p = block(10), *q = p; OPAQUE(q); free(p); free(q);", TWICE
    yield "char *p = block(9000), *q = p; OPAQUE(q); free(p); free(q);", TWICE
    yield "char *p = block(10), *q = p; OPAQUE(q); free(p); kept = block(10); free(q);", TWICE
    yield "char *p = block(10), *q = p; OPAQUE(q); free(p); kept = realloc(q, 100);", TWICE
    yield "char a[10], *p = a; OPAQUE(p); fill(p, 10); free(p);", INVALID
    yield "char *p = (char *)&sink; OPAQUE(p); free(p);", INVALID
    yield "char *p = block(100) ; OPAQUE(p); free(p + 16);", INVALID
    yield "char *p = block(100); OPAQUE(p); while (*p != 5) p++; free(p);", INVALID
    # The address of the access that faults is an error itself: CWE-457.
    yield "word **p = malloc(8); OPAQUE(p); *p[1] = 5;", ADDRESS
    yield "word *p = block(8); OPAQUE(p); at = 1 << 28; int i = at; sink = p[i];", OUTSIDE
    # A freed block of which nobody uses the memory again keeps no other one.
    yield "void **p = malloc(64); p[9] = block(44); stale = p; free(p);", LEAK


def batch():
    """Returns the program of all cases that do not end it, and what each must give."""
    cases = []
    for family in (bounds, direct, lifetimes, never_written, leaks, juliet):
        cases += [(family.__name__, *case) for case in family()]
    text = HEAD + "static volatile byte many[256];\n#define putchar_(c) putchar(c)\n"
    expected = {}
    for number, (family, objects, body, finding) in enumerate(cases):
        name = f"case_{number}"
        text += objects.replace("OBJECT", f"object_{number}") + "\n"
        text += f"CASE {name}(void) {{ {body.replace('OBJECT', f'object_{number}')} }}\n"
        expected[name] = (finding or None, f"{family}: {body}")
    calls = "".join(f"  {name}();\n" for name in expected)
    text += f"int main(void) {{\n  char room[64];\n  fill(room, sizeof room);\n{calls}  return 0;\n}}\n"
    return text, expected


def single():
    cases = list(fatal())
    text = HEAD
    for number, (body, _) in enumerate(cases):
        text += f"CASE case_{number}(void) {{ {body} }}\n"
    text += "int main(int argc, char **argv) {\n  (void)argc;\n  switch (atoi(argv[1])) {\n"
    text += "".join(f"  case {number}: case_{number}(); break;\n" for number in range(len(cases)))
    return text + "  }\n  return 0;\n}\n", [finding for _, finding in cases]
