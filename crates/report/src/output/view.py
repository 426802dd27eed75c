"""Shows the models of this folder in ParaView: side by side, deformed, on one colour scale.

    paraview --script=view.py             opens them in a window
    pvpython view.py picture.png          writes a picture of the last step
    pvpython view.py picture.png ARRAY    the same, coloured by another array

Arrays with `at_nodes` in their names are averaged at the nodes; those in the cells are the values in their middles.
"""
import os
import sys

import numpy
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy

FOLDER = os.path.dirname(os.path.abspath(globals().get("__file__", "view.py")))
MODELS = ["mass_spring", "corrected", "finite_element"]
COLOUR = sys.argv[2] if len(sys.argv) > 2 else "von_mises_stress_at_nodes_MPa"


def deformed(name):
    """The deformed sheet of a model at its last step."""
    file = os.path.join(FOLDER, name + ".pvd")
    reader = simple.PVDReader(registrationName=name, FileName=file)
    warped = simple.WarpByVector(registrationName=name + ", deformed", Input=reader)
    warped.Vectors = ["POINTS", "displacement_mm"]
    warped.UpdatePipeline(max(reader.TimestepValues))
    return warped


def coloured(source):
    """Where the array is that gives the colour, and its range without a fiftieth of the places at each end."""
    data = servermanager.Fetch(source)
    for where, arrays in [("POINTS", data.GetPointData()), ("CELLS", data.GetCellData())]:
        array = arrays.GetArray(COLOUR)
        if array:
            values = vtk_to_numpy(array)
            sizes = values if values.ndim == 1 else numpy.linalg.norm(values, axis=1)
            return where, numpy.nanpercentile(sizes, [2, 98])
    names = source.PointData.keys() + source.CellData.keys()
    sys.exit("no array " + COLOUR + "; there are: " + ", ".join(names))


def look_at(view, source):
    """Sees the whole sheet from above, in parallel projection, in a view three times as wide as high."""
    left, right, bottom, top, _, _ = source.GetDataInformation().GetBounds()
    middle = [0.5 * (left + right), 0.5 * (bottom + top)]
    view.CameraParallelProjection = 1
    view.CameraFocalPoint = [*middle, 0.0]
    view.CameraPosition = [*middle, 10.0 * (right - left)]
    view.CameraViewUp = [0.0, 1.0, 0.0]
    view.CameraParallelScale = 0.6 * max(top - bottom, (right - left) / 2.4)


def main():
    names = [name for name in MODELS if os.path.exists(os.path.join(FOLDER, name + ".pvd"))]
    if not names:
        sys.exit("no .pvd file of a model beside view.py: run the study with vtk = true")
    sources = [deformed(name) for name in names]
    places = [coloured(source) for source in sources]
    low, high = min(ends[0] for _, ends in places), max(ends[1] for _, ends in places)
    simple.LoadPalette("WhiteBackground")
    layout = simple.CreateLayout("gelbench")
    cell, views = 0, []
    for index, (name, source, (where, _)) in enumerate(zip(names, sources, places)):
        view = simple.CreateView("RenderView")
        view.InteractionMode = "2D"
        if index + 1 < len(names):
            layout.SplitVertical(cell, 1.0 / (len(names) - index))
            layout.AssignView(2 * cell + 1, view)
            cell = 2 * cell + 2
        else:
            layout.AssignView(cell, view)
        display = simple.Show(source, view)
        # Colours as the bar has them, without light and shade.
        display.Ambient, display.Diffuse = 1.0, 0.0
        simple.ColorBy(display, (where, COLOUR))
        display.SetScalarBarVisibility(view, True)
        simple.Show(simple.Text(Text=name.replace("_", " ")), view)
        views.append(view)
    colours = simple.GetColorTransferFunction(COLOUR)
    colours.ApplyPreset("Viridis (matplotlib)", True)
    colours.RescaleTransferFunction(low, high)
    scene = simple.GetAnimationScene()
    scene.UpdateAnimationUsingDataTimeSteps()
    scene.GoToLast()
    simple.RenderAllViews()
    for view, source in zip(views, sources):
        look_at(view, source)
    simple.RenderAllViews()
    if len(sys.argv) > 1:
        layout.SetSize(1400, 420 * len(names))
        simple.SaveScreenshot(sys.argv[1], layout)


main()
