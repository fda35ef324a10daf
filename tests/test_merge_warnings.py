"""Warnings of several PLCs as one."""

from DelaunayMesher.merge_warnings import merged


def test_equal_words_make_one_warning():
    assert merged(
        [
            "far smaller: Face5, Face8, Edge9 and 4 more; a size keeps them",
            "in 6 place(s) the mesh is constrained",
            "far smaller: Edge7, Face5; a size keeps them",
            "in 2 place(s) the mesh is constrained",
            "walls need elements of 1.47 mm; they get 15 mm.",
            "walls need elements of 15 mm; they get 4.3e-05 mm.",
        ]
    ) == [
        "far smaller: Face5, Face8, Edge7, Edge9 and 4 more; a size keeps them",
        "in 8 place(s) the mesh is constrained",
        "walls need elements of 1.47 mm; they get 4.3e-05 mm.",
    ]


def test_of_places_the_first_stands():
    texts = ["3 element(s) near (1, 2, 3); cut", "4 element(s) near (-0.5, 2e-05, 30); cut"]
    assert merged(texts) == ["7 element(s) near (1, 2, 3); cut"]


def test_long_lists_are_cut_short():
    text = "replaced there (%s)"
    first, second = (", ".join("Face%d" % n for n in numbers) for numbers in (range(1, 9), range(9, 15)))
    shown = ", ".join("Face%d" % n for n in range(1, 13))
    assert merged([text % first, text % second]) == [text % (shown + " and 2 more")]


def test_what_differs_stays():
    texts = ["the wall Face3 is open", "the gap at Face3 is open", "10 mm", "3 of them"]
    assert merged([*texts, texts[0]]) == texts
