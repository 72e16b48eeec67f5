"""What is wrong with a file that is converted."""


class ConvertError(Exception):
    """`errors`: a line for each, with the element, the value, and what is allowed."""

    def __init__(self, *errors):
        super().__init__('\n'.join(errors))
        self.errors = list(errors)
