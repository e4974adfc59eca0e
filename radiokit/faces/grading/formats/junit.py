"""JUnit XML: a grade as a test report, a suite for each question and a case for each part."""

from __future__ import annotations

from xml.etree import ElementTree

from radiokit.faces.grading.formats.shown import line_of, notes_of, number, plain
from radiokit.faces.grading.grades import Grade

__all__ = ["to_junit"]


def to_junit(grade: Grade, *, reveal: bool = False) -> str:
    """Return a grade as JUnit XML.

    A part without full points is a failure, whose type is the diagnosis; one that could not be judged is an
    error; one that is not graded yet is skipped. Points are properties of cases and suites.

    Parameters
    ----------
    grade : Grade
    reveal : bool
        Whether what was found about hidden parts is told.
    """
    grade = plain(grade)
    root = ElementTree.Element("testsuites", name=grade.title)
    totals = dict.fromkeys(("tests", "failures", "errors", "skipped"), 0)
    for question in grade.questions:
        suite = ElementTree.SubElement(root, "testsuite", name=question.name)
        _properties(suite, {"title": question.title, "score": question.score, "points": question.points})
        counts = dict.fromkeys(totals, 0)
        for part in question.parts:
            line = line_of(part, grade.language, reveal=reveal)
            case = ElementTree.SubElement(
                suite,
                "testcase",
                classname=f"{grade.assignment}.{question.name}",
                name=line.title,
            )
            values: dict[str, str | float] = {
                "score": part.score,
                "points": part.points,
                "visibility": part.visibility,
                "diagnosis": line.diagnosis,
            }
            _properties(case, values)
            counts["tests"] += 1
            if line.standing == "pending":
                counts["skipped"] += 1
                ElementTree.SubElement(case, "skipped", message=line.text)
            elif line.standing != "full":
                kind = "error" if question.review else "failure"
                counts[f"{kind}s"] += 1
                message = f"{line.score} / {line.points}: {line.text}"
                element = ElementTree.SubElement(case, kind, message=message, type=line.diagnosis or "points")
                element.text = "\n".join([line.text, *notes_of(grade, question)])
        for name, cases in counts.items():
            suite.set(name, str(cases))
            totals[name] += cases
    for name, cases in totals.items():
        root.set(name, str(cases))
    ElementTree.indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + ElementTree.tostring(root, encoding="unicode") + "\n"


def _properties(element: ElementTree.Element, values: dict[str, str | float]) -> None:
    parent = ElementTree.SubElement(element, "properties")
    for name, value in values.items():
        text = value if isinstance(value, str) else number(value)
        ElementTree.SubElement(parent, "property", name=name, value=text)
