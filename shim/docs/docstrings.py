# SPDX-License-Identifier: MIT
"""An extension of mkdocstrings: the roles of docstrings, such as :func:`rlvc.learn`, become links.

A role whose name leads nowhere is a warning. What exists but has no place in the reference is shown without a link."""

import re

import griffe

ROLE = re.compile(r":(?:py:)?(?:func|meth|class|attr|mod|data|exc|obj):`(~?)([\w.]+)`")
LOG = griffe.get_logger("rlvc")


class Roles(griffe.Extension):
    """Replaces the roles in all docstrings of a package once it is loaded."""

    def on_package(self, *, pkg, **_):
        self.package = pkg
        self.visit(pkg)

    def visit(self, thing):
        if thing.docstring:
            thing.docstring.value = ROLE.sub(lambda match: self.link(thing, *match.groups()), thing.docstring.value)
        for member in getattr(thing, "members", {}).values():
            if not member.is_alias:
                self.visit(member)

    def link(self, thing, short, path):
        shown = f"<code>{path.rsplit('.', 1)[-1] if short else path}</code>"
        found = self.find(thing, path)
        if found is None:
            LOG.warning(f"{thing.path}: its docstring names {path}, which does not exist")
            return shown
        owner = found.rsplit(".", 2)[-2]
        if owner.istitle() and owner not in self.package.members:
            return shown  # of a base class, whose members appear with each class that is made of it
        return f'<autoref identifier="{found}" optional>{shown}</autoref>'

    def find(self, thing, path):
        """The full name of what a docstring calls by a shorter one: of its class, its module or the package."""
        scope = thing
        while scope is not None:
            found = self.member(scope, path)
            if found:
                return found
            scope = scope.parent
        return self.member(self.package, path.removeprefix("rlvc.")) if path != "rlvc" else "rlvc"

    def member(self, scope, path):
        try:
            found = scope.all_members[path.split(".")[0]] if "." not in path else scope[path]
            return found.final_target.path if found.is_alias else found.path
        except (KeyError, ValueError, AttributeError, griffe.AliasResolutionError, griffe.CyclicAliasError):
            return None
