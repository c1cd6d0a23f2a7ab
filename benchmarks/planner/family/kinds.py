"""A table of kinds, and the decorator that enters a function under its name."""


def make_table():
    table = {}

    def kind(make):
        table[make.__name__] = make
        return make

    return table, kind
