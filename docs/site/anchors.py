"""The anchors of headings in the site."""

import re


def slug(heading, separator):
    """As GitHub makes them, and as the links of the pages expect them."""
    return re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", separator)
