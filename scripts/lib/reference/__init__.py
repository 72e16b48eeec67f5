"""The pages of doc/reference, made from the sources: each module has a function `page(...)` that returns Markdown."""
