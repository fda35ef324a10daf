"""Collects what the window shows into the .ts files, keeping translations, and compiles them.

    python3 resources/translations/update.py        needs lrelease (Debian: qttools5-dev-tools)

The texts are the strings in tr(...) calls, those of the options table, and the tables of names that are
translated when they are shown.  Missing translations are listed.
"""

import ast
import os
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
PACKAGE = os.path.join(ROOT, "DelaunayMesher")
CONTEXT = "DelaunayMesher"
TABLES = {"STAGES", "REASONS", "CHOICE_LABELS", "CUTS", "MEASURES", "LABELS", "KIND_LABELS"}


def texts_of(path):
    """Strings of a file that are shown in the window."""
    with open(path, encoding="utf-8") as file:
        tree = ast.parse(file.read())
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "tr":
            if isinstance(node.args[0], ast.Constant):
                yield node.args[0].value
        elif isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") in TABLES:
            yield from table_texts(node.value)


def constants(node):
    """String constants in an expression."""
    for part in ast.walk(node):
        if isinstance(part, ast.Constant) and isinstance(part.value, str):
            yield part.value


def table_texts(node):
    """What is shown of a table of names: a dict's values, the first string of each row of a tuple."""
    if isinstance(node, ast.Dict):
        for value in node.values:
            yield from constants(value)
        return
    for row in node.elts:
        first = row.args[0] if isinstance(row, ast.Call) else row.elts[0]
        yield from constants(first)


def option_texts():
    """Labels, helps and groups of the options table."""
    sys.path.insert(0, ROOT)
    from DelaunayMesher.options import OPTIONS

    for option in OPTIONS:
        yield option.label
        yield option.help[:1].upper() + option.help[1:]
        yield option.group


def all_texts():
    """Every text once, in a stable order."""
    found = []
    folder = os.path.join(PACKAGE, "gui")
    for name in sorted(os.listdir(folder)):
        if name.endswith(".py"):
            found += texts_of(os.path.join(folder, name))
    return list(dict.fromkeys([*found, *option_texts(), *property_texts()]))


def property_texts():
    """Helps of the properties of a size region: the third string of each row."""
    with open(os.path.join(PACKAGE, "document", "size_region.py"), encoding="utf-8") as file:
        tree = ast.parse(file.read())
    for node in tree.body:
        if isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") == "PROPERTIES":
            for row in node.value.elts:
                yield row.elts[2].value


def read_translations(path):
    """{text: translation} of a .ts file."""
    if not os.path.exists(path):
        return {}
    return {
        message.findtext("source"): message.findtext("translation") or ""
        for message in ElementTree.parse(path).iter("message")
    }


def write_translations(path, language, texts, known):
    """A .ts file with the texts; returns those without a translation."""
    root = ElementTree.Element("TS", version="2.1", language=language, sourcelanguage="en")
    context = ElementTree.SubElement(root, "context")
    ElementTree.SubElement(context, "name").text = CONTEXT
    missing = []
    for text in texts:
        message = ElementTree.SubElement(context, "message")
        ElementTree.SubElement(message, "source").text = text
        translation = ElementTree.SubElement(message, "translation")
        translation.text = known.get(text, "")
        if not translation.text:
            translation.set("type", "unfinished")
            missing.append(text)
    ElementTree.indent(root)
    body = ElementTree.tostring(root, encoding="unicode")
    with open(path, "w", encoding="utf-8") as file:
        file.write('<?xml version="1.0" encoding="utf-8"?>\n<!DOCTYPE TS>\n%s\n' % body)
    return missing


def lrelease():
    """The program that compiles .ts files."""
    for name in ("lrelease", "lrelease-qt5", "/usr/lib/qt5/bin/lrelease"):
        found = shutil.which(name)
        if found:
            return found
    sys.exit("lrelease is not installed (Debian: qttools5-dev-tools)")


def main():
    texts = all_texts()
    for name in sorted(os.listdir(HERE)):
        if name.endswith(".ts"):
            path = os.path.join(HERE, name)
            language = name[:-3].split("_", 1)[1]
            missing = write_translations(path, language, texts, read_translations(path))
            subprocess.run([lrelease(), "-silent", path], check=True)
            print("%s: %d texts, %d missing" % (name, len(texts), len(missing)))
            for text in missing:
                print("   ", text)


if __name__ == "__main__":
    main()
