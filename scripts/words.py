#!/usr/bin/env python3
"""Check the language of relume: pages, help, messages, comments and commit subjects.

Prints each rule with its total and its worst places. --summary prints "NAME TOTAL" per rule. Saved to
a file, it is what --ceiling FILE compares with (exit 1 above it). A hit is a hint: some are right
English, so totals have ceilings that only fall (scripts/words.ceiling, `make lint`).
"""
import argparse
import collections
import os
import re
import subprocess
import sys

Finding = collections.namedtuple("Finding", "rule path line size text")
Prose = collections.namedtuple("Prose", "origin path line text")  # origin: page, comment, string

MOST_WORDS = {"tutorial": 900, "how-to": 900, "explanation": 1200, "reference": 1500,
              "measurement": 1500, "changes": 600, "index": 500, "specification": 10000}
MOST_SENTENCE, MOST_MEAN, MOST_PARAGRAPH, MOST_COLUMNS, MOST_HELP, MOST_SUBJECT = 30, 18, 90, 120, 90, 65
KINDS = {"tutorials": "tutorial", "reference": "reference", "measurements": "measurement", "changes": "changes",
         "README": "index", "format": "specification", "conventions": "reference", "glossary": "reference"}
KIND_MARK = re.compile(r"<!-- kind: ([a-z-]+) -->")  # a page may name its kind in its first lines
SOURCES, COMMENTED = ("src", "viewer", "include", "web"), (".c", ".h", ".cpp", ".glsl", ".js")

PATTERNS = [  # name, signature: write who does what instead, in one full sentence
    ("say-of", r"\b(?:says?|said|saying|tells?|told) of\b"),
    ("what-x-has-of-y", r"\bwhat (?:[\w`'-]+ ){1,5}(?:has|have|makes?|shows?|knows?|takes?|misses?|sees?|needs?) of\b|"
                        r"\bwhat of (?:a|an|it|its|the|them)\b"),
    ("foretell", r"\bfore(?:tell|told|see|saw)\w*\b|\b(?:is|are|was|were) met\b|\bmet to\b"),
    ("instead", r"\bin place of\b|\bfor want of\b"),
    ("that-of", r"\b(?:is|are|was|were|be|as|than|to|by|from|in) (?:that|those) of\b"),
    ("so-many", r"\bso (?:many|much|often)\b|\bas (?:many|much|often) as (?:there|it|that|what|the)\b"),
    ("nothing-none", r"\bnothing of\b|\b(?:is|are|has|have|of|but) none\b|\bwhere (?:\w+ \w+ )?(?:nothing|none)\b"),
    ("nobody", r"\b(?:nobody|anybody|somebody|whoever|a stranger)(?:'s)?\b"),
    ("else-tail", r"[,;] else\b|\belse:"),
    ("fronted", r"(?:^|[.;:] )(?:Of (?!course)|By (?!default)|Besides|Beside|Beyond|Other than)"),
    ("what-subject", r"(?:^|[.;] )What (?:[^.?]|\.\w)+\.(?= |$)"),
    ("person", r"\b(?:files?|pages?|programs?|views?|viewer|renderers?|library|lamps?|pixels?|parts?|models?|captures?|"
               r"tool|panel|sentences?) (?:knows?|wants?|asks? for|minds?|forgets?|believes?|sees?|says?|learns?)\b"),
    ("before-in-space", r"\b(?:stands?|stood|lies?|lay) (?:before|beside|behind)\b|\bbefore the (?:eye|wall|lamp)"),
    ("bare-pronoun", r"\b(?:what others|the others|the one so|of such|such ones|these alone|none else)\b"),
    ("history", r"\bas before\b|\bof before\b|\bno longer\b|\b(?:\d[\w.%]*|dB|it was|they were) before\b|"
                r"\(before:|\bearlier (?:states?|versions?)\b|\d[^.;]{0,30} in place of (?:\d|about)"),
    ("chain", r"[^.!?\n]*;[^.!?;\n]*;[^.!?\n]*"),
    ("folklore", r"\bwithout a word\b|\bmost so\b|\banew\b|\bwish(?:es)?\b|\boff each other\b|\bmisses by\b"),
    ("words-md", r"\bstands? for\b|\btaken for\b|\bcontradicts? the\b|\bcodes of the display domain\b"),
]
GLOSSARY = [  # the word to use, signature of the others
    ("held-out light", r"\b(?:lights?|lamps?|photographs?|samples?) (?:that (?:are|were) )?left out\b"),
    ("lossy", r"\bwith(?:out)? loss\b"),
    ("per pixel", r"\b(?:bytes?|bits?|numbers?|rays?|samples?|halves|halfs|lights?|words?|floats?|coefficients|"
                  r"texels?) an? (?:pixel|light|lamp|view|texel|side|channel|place|row|line)\b"),
    ("point, position", r"(?<!in )(?<!to )(?<!take )(?<!takes )\bplaces?\b"),
    ("message", r"\b(?:a|one|in one|with a|the|these|their|own) sentences?\b"),
    ("codebook", r"\bbooks?\b"),
    ("memory", r"\broom (?:for|is)\b|\bno room\b|\b(?:makes?|made|needs?|takes) room\b"),
    ("GPU", r"\bthe cards?\b|\b(?:a|without) card\b"),
    ("transport method", r"\bways? of (?:light|transport)\b|\b(?:each|this|other|all) ways? (?:gathers?|finds?|of)\b"),
    ("copy (not twin)", r"\b[Tt]wins?\b(?!:)"),
    ("near light", r"\b(?:near|distant|captured|far|new) lamps?\b"),
    ("camera", r"\b(?:the|an|free|its) eyes? (?:sees?|is|looks?|stands?|moves?|that)\b"),
    ("bright source", r"\bsuns\b"),
]
SIGNATURES = ([("idiom:" + name, re.compile(p, re.I)) for name, p in PATTERNS] +
              [("word:" + name, re.compile(p)) for name, p in GLOSSARY])
OPENING = re.compile(r"(?:Of|What|Whether|How|Who|Whose|Which|As)\b(?! an? \w+:)|Where\b[^,]*?(?:[.:;]|$)")
VERBS = set("""accept add allow apply avoid build cache change check choose clean close compare compress compute
convert copy correct count cover decode define delete describe detect document draw drop encode ensure explain export
extend fit fix format generate handle ignore implement import improve include join keep limit list load make measure
merge move name open parse port prevent print publish read record reduce refuse reject release remove rename render
replace report require restore revert rewrite run save select send set share shorten show simplify skip sort split
start stop store support test time translate trim unify update use warn write""".split())


STRING = r'"(?:\\.|[^"\\\n])*"'
TOKEN = re.compile(STRING + r"|'(?:\\.|[^'\\\n])*'|`(?:\\.|[^`\\])*`|//[^\n]*|/\*.*?\*/", re.S)
JOINED = re.compile(STRING + r"(?:[\s\\]*" + STRING + ")*")
OPTION_ROW = re.compile(r"^[ \t]*(?:GROUP|FLAG|INT|NUMBERS?|TEXTS?|TEXT_AS|PROSE|NAME|OUTPUT|POINTS?|SIZE|OWN|"
                        r"TRANSFER|WORDS|ENTRY|ENTRIES|BYTES)\(", re.M)
NOT_PROSE, ITEM = re.compile(r"```|    |\t|\s*\||#|!\[|<"), re.compile(r"^\s*(?:[-*]|\d+\.) ")


def words(text):
    return len(re.findall(r"[^\s|]*\w[^\s|]*", text))


def sentences(text):
    return [s for s in re.split(r"\n|(?<=[.!?])[)\"']?\s+(?=[A-Z`\"(\[<])", text) if words(s) > 1]


def read(path):
    with open(path, encoding="utf-8", errors="replace") as f:
        return f.read()


def files(tree, folder, endings):
    for where, folders, names in os.walk(os.path.join(tree, folder)):
        folders[:] = sorted(f for f in folders if not f.startswith(".") and f != "build")
        yield from (os.path.join(where, n) for n in sorted(names) if n.endswith(endings))


def page_kind(path, text):
    mark = KIND_MARK.search(text[:500])
    name, folder = os.path.basename(path)[:-3], os.path.basename(os.path.dirname(path))
    kind = mark.group(1) if mark else KINDS.get(name, KINDS.get(folder, "how-to"))
    return kind if kind in MOST_WORDS else "how-to"


def plain(markdown):
    """Links as their text, code as one word."""
    text = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", markdown)
    return re.sub(r"`[^`]*`", lambda m: m.group().replace(" ", "_"), text)


def paragraphs(path, text, found):
    """The prose of a page, without code, tables, headings and pictures; notes overlong lines."""
    start, lines, fenced = 0, [], False
    for number, line in enumerate(text.split("\n") + [""], 1):
        fenced ^= line.startswith("```")
        stop = fenced or not line.strip() or NOT_PROSE.match(line)
        if lines and (stop or ITEM.match(line)):
            yield Prose("page", path, start, plain(" ".join(lines)))
            lines = []
        if not stop:
            if len(line) > MOST_COLUMNS:
                found.append(Finding("columns", path, number, len(line), line))
            start = start if lines else number
            lines.append(ITEM.sub("", line, 1).strip())


def check_page(path, found):
    text = read(path)
    kind = page_kind(path, text)
    size = words(re.sub(r"^```.*?^```|^(?:    |\t).*?$", "", text, flags=re.S | re.M))
    if size > MOST_WORDS[kind]:
        found.append(Finding("page", path, 1, size, "%s: at most %d words" % (kind, MOST_WORDS[kind])))
    prose = list(paragraphs(path, text, found))
    said = [words(s) for p in prose for s in sentences(p.text)]
    if len(said) > 5 and sum(said) / len(said) > MOST_MEAN:
        found.append(Finding("page-mean", path, 1, round(sum(said) / len(said), 1), "words per sentence"))
    found += [Finding("paragraph", p.path, p.line, words(p.text), p.text)
              for p in prose if words(p.text) > MOST_PARAGRAPH]
    return prose


def comments(path):
    """Blocks of comments; consecutive lines are one block."""
    text, blocks, end = read(path), [], (-1, -1)
    for m in TOKEN.finditer(text):
        if m.group()[0] != "/":
            continue
        line, begin = text.count("\n", 0, m.start()) + 1, text.rfind("\n", 0, m.start()) + 1
        body = re.sub(r"\s*\n\s*\*?\s*", " ", re.sub(r"^/[/*]+|\*/$", "", m.group())).strip()
        alone = not text[begin:m.start()].strip()
        if alone and end == (line - 1, m.start() - begin):
            blocks[-1] = blocks[-1]._replace(text=blocks[-1].text + " " + (body or "\n"))
        else:
            blocks.append(Prose("comment", path, line, body))
        end = (line + m.group().count("\n"), m.start() - begin)
    return blocks


def check_strings(path, found):
    """Help and messages of the tool: strings of three words or more."""
    text = TOKEN.sub(lambda m: re.sub(r"[^\n]", " ", m.group()) if m.group()[0] == "/" else m.group(), read(path))
    rows, prose = [m.start() for m in OPTION_ROW.finditer(text)], []
    for m in JOINED.finditer(text):
        said, line = "".join(t[1:-1] for t in re.findall(STRING, m.group())), text.count("\n", 0, m.start()) + 1
        if words(said) < 3:
            continue
        row = max((r for r in rows if r < m.start()), default=None)
        if row is not None and ")," not in text[row:m.start()] and len(said) > MOST_HELP:
            found.append(Finding("help", path, line, len(said), said))
        prose.append(Prose("string", path, line, said))
    return prose


def check_prose(prose, found):
    for p in prose:
        comment = p.origin == "comment"
        if comment and OPENING.match(p.text):
            found.append(Finding("comment-opening", p.path, p.line, words(p.text), p.text))
        found += [Finding("sentence-" + p.origin, p.path, p.line, words(s), s)
                  for s in sentences(p.text) if words(s) > MOST_SENTENCE]
        for rule, signature in SIGNATURES:
            found += [Finding(rule, p.path, p.line, len(m.group()), p.text[max(0, m.start() - 40):m.end() + 40])
                      for m in signature.finditer(p.text, 1 if comment else 0)]  # 1: the opening is judged above


def check_subjects(tree, found):
    command = ["git", "-C", tree, "log", "-50", "--no-merges", "--format=%h %s"]
    for line in subprocess.run(command, capture_output=True, text=True).stdout.splitlines():
        commit, _, subject = line.partition(" ")
        if len(subject) > MOST_SUBJECT:
            found.append(Finding("subject-long", commit, 0, len(subject), subject))
        if subject.rpartition(": ")[2].split(" ")[0].lower() not in VERBS:
            found.append(Finding("subject-verb", commit, 0, len(subject), subject))


def check(tree):
    found, prose = [], []
    for path in [os.path.join(tree, "README.md"), *files(tree, "docs", ".md")]:
        prose += check_page(path, found) if os.path.exists(path) else []
    for folder in SOURCES:
        prose += [block for path in files(tree, folder, COMMENTED) for block in comments(path)]
    for path in files(tree, os.path.join("src", "cli"), (".c", ".h")):
        prose += check_strings(path, found)
    check_prose(prose, found)
    check_subjects(tree, found)
    return [f._replace(path=os.path.relpath(f.path, tree)) if f.line else f for f in found]


def compare(totals, ceiling):
    allowed = dict(line.rsplit(" ", 1) for line in read(ceiling).splitlines())
    # Subjects are listed only: commits cannot be mended, and the tree must not fail by its history.
    worse = [n for n, total in sorted(totals.items())
             if total > int(allowed.get(n, 0)) and not n.startswith("subject-")]
    print("".join("words: %s: %d findings, at most %s are allowed; scripts/words.py --rule '%s' lists them\n" %
                  (n, totals[n], allowed.get(n, 0), n) for n in worse), end="")
    return 1 if worse else 0


def worst_of(found, is_pattern):
    """The largest findings; of a pattern one in each file, by how many the file has."""
    if not is_pattern:
        return sorted(found, key=lambda f: (-f.size, f.path))
    count = collections.Counter(f.path for f in found)
    first = {f.path: f._replace(size=count[f.path]) for f in reversed(found)}
    return sorted(first.values(), key=lambda f: (-f.size, f.path))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tree", nargs="?", default=".")
    parser.add_argument("--summary", action="store_true")
    parser.add_argument("--rule")
    parser.add_argument("--worst", type=int, default=5)
    parser.add_argument("--ceiling")
    args = parser.parse_args()
    rules = collections.defaultdict(list)
    for f in check(args.tree):
        rules[f.rule].append(f)
    if args.ceiling:
        sys.exit(compare({name: len(f) for name, f in rules.items()}, args.ceiling))
    for name in [args.rule] if args.rule else sorted(rules):
        print("%s %d" % (name, len(rules[name])))
        worst = [] if args.summary else worst_of(rules[name], name.startswith(("idiom:", "word:")))
        for f in worst[:args.worst]:
            print("  %s:%d: %s: %s" % (f.path, f.line, f.size, f.text[:140].replace("\n", " ")))


if __name__ == "__main__":
    main()
