"""Objects that were made without a window have no view of ours; they get one when the window opens them."""


def complete(target, provider):
    """Give an object that has just been opened the view provider, unless it has it.

    FreeCAD hides what has no view, and shows objects like ours again only when they never get one.
    """
    view = target.ViewObject
    if not isinstance(view.Proxy, provider):
        provider(view)
        view.show()
