"""The assignments that come with radiokit, one file each: questions, references and texts, no solutions.

What a long one consists of is in the folder of its name, behind an underscore.
"""
