"""The rows of options.py as properties of a document object, and back."""

from ..options import OPTIONS, MeshOptions

EMPTY_NUMBERS = {"App::PropertyLength": 0.0, "App::PropertyFloat": 0.0, "App::PropertyAngle": 0.0}
ORDER_NAMES = ("1st", "2nd")  # as FreeCAD's other meshers call them


def add_option_properties(target):
    """Add what is missing (an old document's object gets the new options with their defaults)."""
    for option in OPTIONS:
        if hasattr(target, option.property_name):
            continue
        target.addProperty(option.property_type, option.property_name, option.group, sentence(option.help))
        if option.kind == "choice":
            setattr(target, option.property_name, choice_names(option))
        set_option(target, option, option.default)


def sentence(text):
    """With a capital, as property descriptions are written."""
    return text[:1].upper() + text[1:]


def choice_names(option):
    """What an enumeration shows."""
    return list(ORDER_NAMES) if option.name == "order" else [str(choice) for choice in option.choices]


def set_option(target, option, value):
    """Write one option into its property; None (automatic) is 0."""
    if option.kind == "choice":
        value = choice_names(option)[option.choices.index(value)]
    elif value is None:
        value = EMPTY_NUMBERS.get(option.property_type, 0)
    setattr(target, option.property_name, value)


def get_option(target, option):
    """Read one option from its property."""
    value = getattr(target, option.property_name)
    if option.kind == "choice":
        return option.choices[choice_names(option).index(value)]
    value = getattr(value, "Value", value)  # quantities
    if option.default is None and not value:
        return None
    return value


def set_options(target, options):
    """Write all options of a MeshOptions."""
    for option in OPTIONS:
        set_option(target, option, getattr(options, option.name))


def get_options(target, **extra):
    """MeshOptions from the properties; `extra` are sizes, regions and the like.  Raises InputError."""
    return MeshOptions(**{option.name: get_option(target, option) for option in OPTIONS}, **extra)
