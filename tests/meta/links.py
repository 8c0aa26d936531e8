# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Every relative link of a page leads to a file or folder of the tree, and to a heading where it names one.

Usage: links.py ROOT
"""

import re
import sys
from pathlib import Path

from source_tree import files, report

LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")
FENCE = re.compile(r"^```.*?^```", re.MULTILINE | re.DOTALL)
CODE = re.compile(r"`[^`\n]*`")


def pages(root):
    return [path for path in files(root) if path.suffix == ".md"]


def anchors(text):
    """Names under which headings can be reached: lower case, no punctuation, - for blanks."""
    found = set()
    for heading in re.findall(r"^#+ +(.*)$", FENCE.sub("", text), re.MULTILINE):
        words = re.sub(r"[^\w\- ]", "", re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading))
        name, number = words.strip().lower().replace(" ", "-"), 0
        while name + (f"-{number}" if number else "") in found:
            number += 1
        found.add(name + (f"-{number}" if number else ""))
    return found


def faults_of(root):
    faults = []
    for page in pages(root):
        text = page.read_text()
        shown = CODE.sub("", FENCE.sub("", text))
        for link in LINK.findall(shown):
            if re.match(r"\w+:", link):  # another site
                continue
            name, _, anchor = link.partition("#")
            target = page.parent / name if name else page
            if not target.exists():
                faults.append(f"{page.relative_to(root)}: {link}: there is no such file")
            elif anchor and anchor not in anchors(target.read_text()):
                faults.append(f"{page.relative_to(root)}: {link}: there is no such heading")
    return faults


if __name__ == "__main__":
    sys.exit(report(faults_of(Path(sys.argv[1]))))
