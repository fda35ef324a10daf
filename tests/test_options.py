import dataclasses

import pytest

from DelaunayMesher.errors import InputError
from DelaunayMesher.options import BY_NAME, OPTIONS, MeshOptions, make_options
from DelaunayMesher.sizing import Region


def test_table_and_dataclass_agree():
    fields = {field.name: field for field in dataclasses.fields(MeshOptions)}
    for option in OPTIONS:
        assert fields[option.name].default == option.default
        assert option.check(option.default) == option.default
    assert set(fields) - set(BY_NAME) == {"sizes", "regions", "size_points", "size_values"}


def test_table_is_complete():
    for option in OPTIONS:
        assert option.help and option.label and option.group
        assert option.property_type.startswith("App::Property")
        assert option.property_name[0].isupper()
    assert len({option.property_name for option in OPTIONS}) == len(OPTIONS)
    assert BY_NAME["optimise"].flag == "--no-optimise"
    assert BY_NAME["elements_per_circle"].flag == "--elements-per-circle"


@pytest.mark.parametrize(
    "changes",
    [
        {"max_size": 0},
        {"max_size": -1},
        {"max_size": float("nan")},
        {"max_size": float("inf")},
        {"max_size": "wide"},
        {"max_size": True},
        {"max_size": 1, "min_size": 2},
        {"growth": 0},
        {"growth": None},
        {"elements_per_circle": -1},
        {"order": 3},
        {"order": 1.5},
        {"target_angle": 31},
        {"optimise": 2},
        {"seed": -1},
        {"threads": 0.5},
        {"max_elements": "1.5e0"},
        {"max_elements": "1e400"},
        {"max_elements": "nan"},
        {"sizes": {"Face": 1}},
        {"sizes": {"Face0": 1}},
        {"sizes": {"face1": 1}},
        {"sizes": {"Face1": 0}},
        {"sizes": {"Face1": "x"}},
        {"regions": [Region.ball((0, 0, 0), 0, 1)]},
        {"regions": [Region.box((0, 0, 0), (1, 1, 1), -1)]},
        {"regions": [Region("cone", (0, 0, 0), (0, 0, 0), 1, 1)]},
        {"regions": [Region.ball((0, 0, float("nan")), 1, 1)]},
        {"size_points": [[0, 0, 0]]},
        {"size_points": [[0, 0]], "size_values": [1]},
        {"size_points": [[0, 0, 0]], "size_values": [0]},
        {"colour": "red"},
    ],
)
def test_wrong_options_are_refused(changes):
    with pytest.raises(InputError) as caught:
        make_options(**changes)
    assert caught.value.stage == "options"
    assert caught.value.exit_code == 2


def test_options_from_anything():
    assert make_options().max_size is None
    assert make_options({"max_size": 2}).max_size == 2.0
    assert make_options(MeshOptions(order=2), max_size="3.5").order == 2
    assert repr(make_options(max_elements="1e6", seed="7").max_elements) == "1000000"
    assert make_options(MeshOptions(), sizes={"Face3": "0.5"}).sizes == {"Face3": 0.5}
    with pytest.raises(InputError):
        make_options(3)


def test_changes_make_a_copy():
    first = MeshOptions(max_size=2.0)
    assert first.with_changes(max_size=3.0).max_size == 3.0
    assert first.max_size == 2.0


def test_threads():
    assert MeshOptions(threads=3).used_threads() == 3
    assert 1 <= MeshOptions().used_threads() <= 8
