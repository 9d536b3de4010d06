"""A comparison as text."""

from trax_eval.util import shown

from .figures import SECTIONS
from .runs import is_number

MOST = 8  # rows of a table without --all


def plain(out):
    """`out` for lines with names of files that others may have written: without control characters."""
    return lambda line: out("".join(letter if letter.isprintable() else f"\\x{ord(letter):02x}" for letter in line))


def number(value, signed=False):
    if value is None:
        return "-"
    if not is_number(value):
        return shown(value)
    sign = "+" if signed and value > 0 else ""
    if isinstance(value, int) or abs(value) >= 1000 or value == 0:
        return f"{sign}{value:,.0f}"
    return f"{sign}{value:.4g}"


def cycles(value, signed=False):
    return number(value if value is None or abs(value) < 10 else round(value), signed)


def percent(share):
    """A relative difference, of a great one the factor."""
    if share is None:
        return ""
    return f"{100 * share:+.2f} %" if abs(share) < 10 else f"x {significant(1 + share)}"


def significant(value):
    return f"{value:,.0f}" if abs(value) >= 1000 else f"{value:.3g}"


def part(share):
    """A contribution, of A's cycles. It may be many times as great, with either sign."""
    if share is None:
        return ""
    return f"{100 * share:+.2f} %" if abs(share) < 10 else f"{100 * share:+,.0f} %"


def relative(row):
    a, b = row["a"], row["b"]
    if "only_in" in row:
        return f"only {row['only_in'].upper()}"
    return percent((b - a) / abs(a)) if is_number(a) and is_number(b) and a else ""


def table(out, title, heads, rows, every):
    """heads: one for each column; those of the first and of the last, a text, are to the left."""
    shown = rows if every else rows[:MOST]
    widths = [max(len(row[column]) for row in (heads, *shown)) for column in range(len(heads))]
    widths[0] = max(widths[0], 24)
    heads = (title, *heads[1:])
    widths[0] = max(widths[0], len(title))
    last = len(heads) - 1
    for line, row in enumerate((heads, *shown)):
        cells = [f"{cell:{'<' if column in (0, last) else '>'}{widths[column]}}" for column, cell in enumerate(row)]
        indent = "" if line == 0 else "  "
        out((indent + "  ".join([f"{cells[0]:{widths[0] + 2 - len(indent)}}", *cells[1:]])).rstrip())
    if len(rows) > len(shown):
        out(f"  and {len(rows) - len(shown)} more (--all)")
    out("")


def head(out, comparison):
    for which in "ab":
        run = comparison[which]
        time = "" if run["milliseconds"] is None else f" ({run['milliseconds']:.4g} ms)"
        ends = run["interval"] and run["interval"][0] != run["interval"][1]
        sampled = f", sampled: {cycles(run['interval'][0])} to {cycles(run['interval'][1])}" if ends else ""
        out(f"{which.upper()}  {run['file']}: {run['chip']}, {cycles(run['cycles'])} cycles{time}{sampled}")
    for warning in comparison["warnings"]:
        out(f"warning: {warning}")
    out("")
    found = comparison["cycles"]
    if not found["difference"]:
        out("Both take the same number of cycles.")
    else:
        less = "fewer" if found["difference"] < 0 else "more"
        share = percent(found["relative"])
        out(f"B takes {cycles(abs(found['difference']))} cycles {less} than A{f' ({share})' if share else ''}.")
    if found["interval"]:
        low, high = (cycles(end, True) for end in found["interval"])
        whose = f"{' and '.join(found['sampled'])} {'is' if len(found['sampled']) == 1 else 'are'} sampled"
        out(f"{whose}: the difference is {low} to {high} with 95 % confidence" +
            (", which is within the noise." if found["within_noise"] else ".") +
            " The parts are estimates without intervals; ~ marks parts that are smaller than this noise.")
    out("")


def noise(comparison):
    ends = comparison["cycles"]["interval"]
    return (ends[1] - ends[0]) / 2 if ends else 0


def contributions(out, comparison, name, title, every):
    if not comparison.get(name):
        return
    whole, limit = comparison["cycles"]["a"], noise(comparison)
    rows = [(row["name"], cycles(row["a"]), cycles(row["b"]), cycles(row["difference"], True),
             part(row["difference"] / whole if whole else None),
             ("~ " if abs(row["difference"]) < limit else "") +
             (row["meaning"] if "meaning" in row else f"{row['cause']} {cycles(row['cause_difference'], True)}"
              if "cause" in row else "")) for row in comparison[name]]
    table(out, title, ("", "A", "B", "difference", "of A's cycles", "" if name == "causes" else "most by"), rows,
          every)


def kinds(out, comparison, every):
    if not comparison.get("kinds"):
        return
    rows = [(row["name"], cycles(row["a"]), cycles(row["b"]), cycles(row["difference"], True),
             *(number(row.get(f"{what}_{end}")) for what in ("rays", "cycles_per_ray") for end in "ab"), "")
            for row in comparison["kinds"]]
    table(out, "Kinds of rays, in cycles", ("", "A", "B", "difference", "A: rays", "B: rays", "A: thread-cycles a ray",
                                            "B: thread-cycles a ray", ""), rows, every)


def pictures(out, found):
    if "sizes" in found:
        (one, two), (three, four) = found["sizes"]
        out(f"Pictures: of different sizes, {one}x{two} and {three}x{four}")
    elif not found["different"]:
        out("Pictures: the same")
    else:
        out(f"Pictures: {found['different']:,} of {found['pixels']:,} pixels differ, by at most {found['largest']} "
            "of 255 (--picture FILE.png)")
    if "cost" in found:
        cost, most = found["cost"], found["cost"]["largest"]
        out(f"Pixels: {cost['pixels_less']:,} take fewer thread-cycles and {cost['pixels_more']:,} more "
            f"(--cost-picture FILE.png); most changed: ({most['x']}, {most['y']}), {most['a']:,} to {most['b']:,}")
    out("")


def is_empty(comparison):
    return not (comparison["configuration"] or comparison["causes"] or any(comparison["sections"].values()) or
                any(comparison.get(name) for name in ("functions", "lines", "kinds")) or
                comparison["cycles"]["difference"] or (comparison.get("pictures") or {}).get("different") or
                "sizes" in (comparison.get("pictures") or {}) or "cost" in (comparison.get("pictures") or {}))


def print_comparison(comparison, every, out=print):
    out = plain(out)
    head(out, comparison)
    if is_empty(comparison):
        out("Nothing differs.")
    if comparison["configuration"]:
        table(out, "Configuration", ("", "A", "B", ""), [
            (row["name"], number(row["a"]), number(row["b"]), relative(row) if "only_in" in row else "")
            for row in comparison["configuration"]], True)
    for name, title in (("causes", "Causes, in cycles of a mean thread"), ("functions", "Functions, in cycles"),
                        ("lines", "Lines, in cycles")):
        contributions(out, comparison, name, title, every)
    kinds(out, comparison, every)
    if "pictures" in comparison:
        pictures(out, comparison["pictures"])
    hidden = 0
    for name, title, _, always in SECTIONS:
        rows = comparison["sections"][name]
        if not every and not always:
            hidden += len(rows)
        elif rows:
            table(out, title, ("", "A", "B", "difference", "", ""), [
                (row["name"], number(row["a"]), number(row["b"]), number(row["difference"], True)
                 if row["difference"] is not None else "", relative(row),
                 f"{row['unit']}: {row['meaning']}" if row["unit"] else "") for row in rows], every)
    if hidden:
        out(f"{hidden} other figures differ: of single TMs, TPs and channels, and shares (--all)")
    for name, what in (("profile", "Functions and lines"), ("kinds", "Kinds of rays"), ("picture", "Pictures")):
        if name in comparison["missing"]:
            out(f"{what} are not compared: {comparison['missing'][name]}")


def print_folders(folders, out=print):
    out = plain(out)
    for line in (f"A  {folders['a']}", f"B  {folders['b']}", ""):
        out(line)
    rows = []
    for name, one in folders["runs"].items():
        found, parts = one["cycles"], one["causes"]
        rows.append((name, cycles(found["a"]), cycles(found["b"]), cycles(found["difference"], True),
                     percent(found["relative"]),
                     "within the noise" if found["within_noise"] else
                     f"{parts[0]['name']} {cycles(parts[0]['difference'], True)}" if parts else ""))
    table(out, "Runs, in cycles", ("", "A", "B", "difference", "", "most by"), rows, True)
    if folders["ratio"]:
        out(f"geometric mean of B's cycles over A's: {folders['ratio']:.4f}")
    for which in "ab":
        if folders[f"only_{which}"]:
            out(f"only in {which.upper()}: {', '.join(folders[f'only_{which}'])}")
    for name, one in folders["runs"].items():
        for warning in one["warnings"]:
            out(f"warning: {name}: {warning}")
