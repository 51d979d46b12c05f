#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Sentences of the pages, the messages and the public comments, each alone, for a test of readers.

  sentences.py --seed 7001              60 sentences, 20 of each kind, the kind beside each
  sentences.py --seed 7001 --paths      the file beside each sentence
  sentences.py --list tools/fit         every sentence of the files below a folder

A reader who knows neither the project nor the neighbouring sentences says in other words what each
sentence means. A second reader, who has the sources, counts the right answers.
"""

import argparse
import random
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
LEAST_WORDS = 6


def sentences_of(text):
    """The sentences of a paragraph that have at least LEAST_WORDS words."""
    text = re.sub(r"\s+", " ", text).strip()
    parts = re.split(r'(?<=[.!?])\s+(?=[A-Z`"(])', text)
    return [part.strip() for part in parts if len(part.split()) >= LEAST_WORDS]


def of_page(text):
    """The sentences of a page: paragraphs and items of lists, without tables, headings and code."""
    text = re.sub(r"```.*?```", "\n\n", text, flags=re.S)
    found = []
    for paragraph in re.split(r"\n\s*\n|\n(?=\s*[-*|\d])", text):
        if not paragraph.lstrip().startswith(("|", "#")):
            found += sentences_of(re.sub(r"^\s*[-*]\s+", "", paragraph))
    return found


def of_comments(text):
    """The sentences of the comments of a header."""
    found = []
    block = []
    for line in [*text.splitlines(), ""]:
        comment = re.match(r"\s*///?<?\s?(.*)", line)
        if comment:
            block.append(comment.group(1))
        elif block:
            found += sentences_of(" ".join(block))
            block = []
    return found


def of_messages(text):
    """The texts of at least LEAST_WORDS words in a source file."""
    text = re.sub(r"^\s*//.*$", "", text, flags=re.M)
    text = re.sub(r'"\s*\n\s*"', "", text)
    found = []
    for match in re.finditer(r'"((?:[^"\\\n]|\\.)*)"', text):
        words = match.group(1)
        if words.lstrip().startswith(("<", "SELECT", "INSERT")):
            continue
        own_words = re.sub(r"\{[^}]*\}|%\S+|\\n", " ", words)
        if len(re.findall(r"[A-Za-z]{2,}", own_words)) >= LEAST_WORDS and re.search("[a-z] [a-z]", words):
            found.append(words)
    return found


def all_sentences(below=""):
    """(kind, path, sentence) of every tracked file below a folder."""
    listing = subprocess.run(
        ["git", "ls-files", *([below] if below else [])],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
    )
    found = []
    for path in listing.stdout.split():
        if path.startswith("tests/"):
            continue
        page = path == "README.md" or (
            path.endswith(".md") and path.startswith(("tools/docs", "firmware/docs"))
        )
        readers = {".h": ("comment", of_comments), ".cpp": ("message", of_messages)}
        kind, reader = ("page", of_page) if page else readers.get(Path(path).suffix, (None, None))
        if reader:
            text = (ROOT / path).read_text(encoding="utf-8", errors="replace")
            found += [(kind, path, sentence) for sentence in reader(text)]
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=20, help="sentences of each kind")
    parser.add_argument("--paths", action="store_true", help="print the file of each sentence")
    parser.add_argument("--list", metavar="FOLDER", help="every sentence below a folder")
    options = parser.parse_args()
    if options.list is not None:
        for kind, path, sentence in all_sentences(options.list):
            print(f"{path} [{kind}] {sentence}")
        return 0
    everything = all_sentences()
    chooser = random.Random(options.seed)
    number = 0
    for kind in ("page", "message", "comment"):
        of_kind = [entry for entry in everything if entry[0] == kind]
        for _, path, sentence in chooser.sample(of_kind, options.count):
            number += 1
            where = f" {path}" if options.paths else ""
            print(f"{number}. [{kind}]{where} {sentence}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
