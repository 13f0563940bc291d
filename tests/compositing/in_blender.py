"""Runs inside Blender (blender -b --python in_blender.py -- JOBS.json FOLDER): builds a compositor tree per job and writes EXRs.

A job has a file, an output and one of: socket (as it comes), sum (of sockets, each with an optional weight), matte (type and
name). What Blender says of a file goes to FOLDER/facts.json: sockets, Cryptomatte's layers."""

import json
import pathlib
import re
import sys

import bpy

jobs_file, folder = sys.argv[sys.argv.index("--") + 1 :]
folder = pathlib.Path(folder)
scene = bpy.context.scene
scene.use_nodes = True
tree = scene.node_tree


def image_node(image):
    node = tree.nodes.new("CompositorNodeImage")
    node.image = image
    return node


def mixed(kind, a, b):
    """A socket: a mixed with b, a socket or a colour."""
    node = tree.nodes.new("CompositorNodeMixRGB")
    node.blend_type = kind
    tree.links.new(a, node.inputs[1])
    if isinstance(b, (list, tuple)):
        node.inputs[2].default_value = [*b, 1]
    else:
        tree.links.new(b, node.inputs[2])
    return node.outputs[0]


def sum_of(node, weights):
    total = None
    for name, weight in weights:
        socket = node.outputs[name]
        if weight:
            socket = mixed("MULTIPLY", socket, weight)
        total = socket if total is None else mixed("ADD", total, socket)
    return total


def matte_of(image, kind, name):
    node = tree.nodes.new("CompositorNodeCryptomatteV2")
    node.source = "IMAGE"
    node.image = image
    if kind in matte_layers(image):
        node.layer_name = kind
    node.matte_id = name
    return node.outputs["Matte"]


def matte_layers(image):
    """The menu of the node; Blender tells it only when refusing what is not in it."""
    node = tree.nodes.new("CompositorNodeCryptomatteV2")
    node.source = "IMAGE"
    node.image = image
    try:
        node.layer_name = "no such layer"
    except TypeError as refusal:
        return re.findall(r"'([^']*)'", str(refusal).split("not found in")[-1])
    finally:
        tree.nodes.remove(node)


def write(socket, output):
    node = tree.nodes.new("CompositorNodeOutputFile")
    node.base_path = str(folder)
    node.format.file_format = "OPEN_EXR"
    node.format.color_mode = "RGBA"
    node.format.color_depth = "32"
    node.format.exr_codec = "ZIP"
    node.file_slots.clear()
    node.file_slots.new(output + "_#")
    tree.links.new(socket, node.inputs[0])


facts = {}
jobs = json.loads(pathlib.Path(jobs_file).read_text(encoding="utf-8"))
for file in dict.fromkeys(job["file"] for job in jobs):
    tree.nodes.clear()
    image = bpy.data.images.load(str(folder / file))
    node = image_node(image)
    facts[file] = {
        "sockets": {s.name: s.type for s in node.outputs if s.enabled},
        "type": image.type,
        "mattes": matte_layers(image),
        "refused": {},
    }
    for job in (job for job in jobs if job["file"] == file):
        try:
            if "socket" in job:
                socket = node.outputs[job["socket"]]
            elif "sum" in job:
                socket = sum_of(node, job["sum"])
            else:
                socket = matte_of(image, *job["matte"])
            write(socket, job["output"])
        except (KeyError, TypeError) as problem:
            facts[file]["refused"][job["output"]] = str(problem)
    tree.links.new(node.outputs[0], tree.nodes.new("CompositorNodeComposite").inputs[0])
    bpy.ops.render.render()
    bpy.data.images.remove(image)
(folder / "facts.json").write_text(json.dumps(facts), encoding="utf-8")
