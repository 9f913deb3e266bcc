"""The error that this package raises, and words for it."""

import difflib
from typing import Iterable


class Error(Exception):
    """One line that names the file, the place in it and the remedy."""


def suggestion(word: str, known: Iterable[str]) -> str:
    """``"; did you mean 'xsub/test'?"``, or nothing where no known word is near."""
    near = difflib.get_close_matches(word, list(known), n=1)
    return f"; did you mean '{near[0]}'?" if near else ""
