"""The assignments that come with radiokit, one file each: questions, references and texts, no solutions."""
