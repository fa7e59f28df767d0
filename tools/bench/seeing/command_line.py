# SPDX-License-Identifier: MIT
"""The command line that these programs share: runs, seeds, and names of what is to be measured."""

import argparse


def parser_of(page, runs, seed=100):
    """A parser with --runs and --seed. PAGE, the docstring of the program, is its help."""
    parser = argparse.ArgumentParser(description=page,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=_positive, default=runs, metavar="N",
                        help="runs of each, with seeds of their own (default: %(default)s)")
    parser.add_argument("--seed", type=int, default=seed, metavar="N",
                        help="the first seed (default: %(default)s)")
    return parser


def add_names(parser, name, known):
    """Add names of KNOWN; none means all of them."""
    parser.add_argument(f"{name}s", nargs="*", type=one_of(known), default=list(known),
                        metavar=name.upper(), help=f"of {'; '.join(known)} (default: all)")


def _positive(text):
    value = int(text) if text.isdecimal() else 0
    if value < 1:
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number of at least 1")
    return value


def one_of(known):
    """The type of arguments that are one of some names."""
    def taken(text):
        if text not in known:
            raise argparse.ArgumentTypeError(f"{text!r} is not one of {'; '.join(known)}")
        return text

    return taken
