"""Registry: finds models by name, in the package's own folder and in other packages' entry points."""

from __future__ import annotations

import importlib
import inspect
import pkgutil
from collections.abc import Callable
from functools import cached_property
from importlib.metadata import entry_points
from typing import Any, Generic, TypeVar

from radiokit.contracts.parameters import build
from radiokit.facts.errors import RadiokitError, UnknownNameError

__all__ = ["Registry"]

Model = TypeVar("Model")


class Registry(Generic[Model]):
    """The models of one kind: one class in each file of ``package``, plus the entry points ``group``.

    Nothing is imported before the first question is asked.
    """

    def __init__(self, kind: str, package: str, base: type, group: str) -> None:
        self.kind, self.package, self.base, self.group = kind, package, base, group

    @cached_property
    def classes(self) -> dict[str, type[Model]]:
        """All model classes, by name, in alphabetical order."""
        found: dict[str, type[Model]] = {}
        package = importlib.import_module(self.package)
        for info in pkgutil.iter_modules(package.__path__):
            if info.name.startswith("_"):
                continue
            module = importlib.import_module(f"{self.package}.{info.name}")
            for _, cls in inspect.getmembers(module, inspect.isclass):
                if cls.__module__ == module.__name__ and issubclass(cls, self.base):
                    self._add(found, cls, module.__name__)
        for point in entry_points(group=self.group):
            try:
                cls = point.load()
            except Exception as error:
                raise RadiokitError(f"the {self.kind} {point.value} cannot be loaded: {error}") from error
            self._add(found, cls, point.value)
        return dict(sorted(found.items()))

    def _add(self, found: dict[str, type[Model]], cls: Any, where: str) -> None:
        if not (inspect.isclass(cls) and issubclass(cls, self.base)):
            raise RadiokitError(f"{where} is no {self.base.__name__}", where=where)
        model: Any = cls
        name = model.name
        if not name:
            raise RadiokitError(f"{where} gives no name: set the class attribute 'name'", where=where)
        if name in found:
            raise RadiokitError(f"two models are called {name!r}: {found[name]} and {cls}", name=name)
        found[name] = model

    def names(self) -> list[str]:
        """Return the names, sorted."""
        return list(self.classes)

    def get(self, name: str) -> type[Model]:
        """Return the class called ``name``."""
        if name not in self.classes:
            raise UnknownNameError(self.kind, name, self.classes)
        return self.classes[name]

    def by_class_name(self, name: str) -> type[Model]:
        """Return the class that is called ``name`` in Python, such as ``GGX``; for a package's lazy names.

        Raises
        ------
        AttributeError
            When there is none.
        """
        for cls in self.classes.values():
            if cls.__name__ == name:
                return cls
        known = ", ".join(cls.__name__ for cls in self.classes.values())
        raise AttributeError(f"{self.package} has no class {name!r}; it has: {known}")

    def lazy_names(self) -> tuple[Callable[[str], type[Model]], Callable[[], list[str]]]:
        """Return a package's ``__getattr__`` and ``__dir__``, which find the classes in its files."""

        def find(name: str) -> type[Model]:
            if name.startswith("_"):
                raise AttributeError(name)
            return self.by_class_name(name)

        return find, lambda: sorted(cls.__name__ for cls in self.classes.values())

    def make(self, name: str, parameters: dict[str, Any]) -> Model:
        """Return the model called ``name`` with these parameters."""
        model: Model = build(self.kind, name, self.get(name), parameters)
        return model
