# SPDX-License-Identifier: MIT
"""Markdown for docs/paper.md."""


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    lines += ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def time(ms):
    if ms is None:
        return "-"
    if ms >= 1000:
        return f"{ms / 1000:.3g} s"
    return f"{ms:.3g} ms"


def small(value):
    return "-" if value is None else f"{value:.1e}"


def count(value):
    return "-" if value is None else f"{value:,}"


def percent(share):
    return f"{100 * share:.0f}"
