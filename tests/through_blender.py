"""Reads an EXR with all its passes by Blender, and writes them as floats, for `formats.py`.

Usage: through_blender.py FILE WRITTEN, with `bpy` on the path: Blender 4.2 or later.
"""

import sys
from pathlib import Path

import bpy

SOCKETS = {"VALUE": "FLOAT", "RGBA": "RGBA", "VECTOR": "VECTOR"}


def main() -> None:
    path, written = [Path(argument).resolve() for argument in sys.argv[1:]]
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    is_new = hasattr(scene, "compositing_node_group")  # Blender 5
    if is_new:
        scene.compositing_node_group = tree = bpy.data.node_groups.new("layers", "CompositorNodeTree")
    else:
        scene.use_nodes = True
        tree = scene.node_tree
        tree.nodes.clear()
    read, write = tree.nodes.new("CompositorNodeImage"), tree.nodes.new("CompositorNodeOutputFile")
    read.image = image = bpy.data.images.load(str(path))
    assert image.type == "MULTILAYER", image.type
    if is_new:
        write.format.media_type = "MULTI_LAYER_IMAGE"
    write.format.file_format, write.format.color_depth = "OPEN_EXR_MULTILAYER", "32"
    write.format.exr_codec = "ZIP"
    if is_new:
        write.directory, write.file_name = str(written.parent), written.stem
    else:
        # It appends the number of the frame.
        write.base_path = str(written.with_suffix(""))
        write.file_slots.clear()
    for output in read.outputs:
        if is_new:
            write.file_output_items.new(SOCKETS[output.type], output.name)
            tree.links.new(output, write.inputs[output.name])
        else:
            write.layer_slots.new(output.name)
            tree.links.new(output, write.inputs[-1])
    # Something has to be rendered for the compositor to run, in the size of the picture.
    scene.camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    scene.collection.objects.link(scene.camera)
    scene.render.engine, scene.cycles.samples = "CYCLES", 1
    scene.render.resolution_x, scene.render.resolution_y = 40, 30
    scene.render.compositor_precision = "FULL"
    bpy.ops.render.render()
    if not is_new:
        written.with_name(f"{written.stem}0001.exr").rename(written)


main()
