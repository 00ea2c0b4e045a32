"""Numbers as JSON that people can read and compare: few digits, a line for each number or list."""

import json
import re


def rounded(value: object) -> object:
    """With as many digits as anybody reads."""
    match value:
        case float():
            return float(f"{value:.6g}")
        case dict():
            return {key: rounded(entry) for key, entry in value.items()}
        case list() | tuple():
            return [rounded(entry) for entry in value]
    return value


def as_text(results: object) -> str:
    """JSON with a line for each number, but for lists, which have a line for themselves."""
    text = json.dumps(rounded(results), indent=1)
    return re.sub(r"\[[^\[\]{}]*\]", lambda found: " ".join(found.group().split()), text) + "\n"
