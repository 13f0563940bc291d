#!/usr/bin/env python3
"""Samples per second of tessera and of Blender's Cycles on the Cornell box of scenes/cornell, side by side.

  scripts/bench/cornell_vs_cycles.py [--tessera build/release/bin/tessera] [--spp 64] [--res 320] [--threads 2] [--rounds 5]

The same geometry, camera, colours, one-sided lamp (a mesh, so that it occludes), box filter of one pixel, five bounces, no clamping,
no denoising, no adaptive sampling. The two alternate; the table gives medians. Loading, BVH and start-up are left out of
both: Cycles reports its render time itself, tessera's is that of `tessera bench`. Needs Blender (Debian: apt install blender).
Also prints the ratio of the picture means, as a check that both render the same scene.
"""
import argparse
import json
import math
import os
import re
import statistics
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SCENE = os.path.join(ROOT, "scenes", "cornell", "cornell.toml")
POSITION, FOV_DEG, SCALE = (0.278, 0.273, -0.8), 39.3077, 0.001
LAMP = [(0.213, 0.5487, 0.227), (0.343, 0.5487, 0.227), (0.343, 0.5487, 0.332), (0.213, 0.5487, 0.332)]  # faces down
RADIANCE = (17, 12, 4)


def read_obj():
    """Vertices, and faces by material, of our own OBJ (relative indices, one usemtl at a time)."""
    folder = os.path.dirname(SCENE)
    vertices, faces, colours, name = [], {}, {}, None
    for line in open(os.path.join(folder, "cornell.obj")):
        words = line.split()
        if words[:1] == ["v"]:
            vertices.append([SCALE * float(x) for x in words[1:4]])
        elif words[:1] == ["usemtl"]:
            name = words[1]
        elif words[:1] == ["f"]:
            corners = [int(w) for w in words[1:]]
            faces.setdefault(name, []).append([c - 1 if c > 0 else len(vertices) + c for c in corners])
    for line in open(os.path.join(folder, "cornell.mtl")):
        words = line.split()
        if words[:1] == ["newmtl"]:
            name = words[1]
        elif words[:1] == ["Kd"]:
            colours[name] = [float(x) for x in words[1:4]]
    return vertices, faces, colours


def inside_blender(options):
    import bpy
    from mathutils import Matrix
    for item in list(bpy.data.objects):
        bpy.data.objects.remove(item)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.device, cycles.samples, cycles.seed = "CPU", options["spp"], 1
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.pixel_filter_type, cycles.filter_width = "BOX", 1.0
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0
    cycles.max_bounces = cycles.diffuse_bounces = 5
    render = scene.render
    render.threads_mode, render.threads = "FIXED", options["threads"]
    render.resolution_x = render.resolution_y = options["res"]
    render.resolution_percentage = 100
    render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
    render.filepath, render.use_file_extension = options["out"], False
    scene.view_settings.view_transform = "Raw"
    scene.world = bpy.data.worlds.new("black")
    scene.world.color = (0, 0, 0)

    def add(name, vertices, faces, shader, inputs, backface=False):
        material = bpy.data.materials.new(name)
        material.use_nodes = True
        nodes, links = material.node_tree.nodes, material.node_tree.links
        nodes.clear()
        surface, output = nodes.new(shader), nodes.new("ShaderNodeOutputMaterial")
        for key, value in inputs.items():
            surface.inputs[key].default_value = value
        socket = surface.outputs[0]
        if backface:  # the back emits nothing
            mix, geometry = nodes.new("ShaderNodeMixShader"), nodes.new("ShaderNodeNewGeometry")
            links.new(geometry.outputs["Backfacing"], mix.inputs[0])
            links.new(socket, mix.inputs[1])
            socket = mix.outputs[0]
        links.new(socket, output.inputs["Surface"])
        mesh = bpy.data.meshes.new(name)
        mesh.from_pydata(vertices, [], faces)
        mesh.materials.append(material)
        scene.collection.objects.link(bpy.data.objects.new(name, mesh))

    vertices, faces, colours = read_obj()
    for name, list_of_faces in faces.items():
        add(name, vertices, list_of_faces, "ShaderNodeBsdfDiffuse", {"Color": colours[name] + [1]})
    add("lamp", LAMP, [(0, 1, 2, 3)], "ShaderNodeEmission", {"Color": [c / 17 for c in RADIANCE] + [1], "Strength": 17}, True)
    lens = bpy.data.cameras.new("camera")
    lens.sensor_fit, lens.angle, lens.clip_start = "VERTICAL", math.radians(FOV_DEG), 1e-3
    camera = bpy.data.objects.new("camera", lens)
    camera.matrix_world = Matrix(((-1, 0, 0, POSITION[0]), (0, 1, 0, POSITION[1]), (0, 0, -1, POSITION[2]), (0, 0, 0, 1)))
    scene.collection.objects.link(camera)
    scene.camera = camera
    bpy.ops.render.render(write_still=True)


def run_cycles(options, folder):
    options = dict(options, out=os.path.join(folder, "cycles.exr"))
    text = subprocess.run(["blender", "-b", "--factory-startup", "--debug-cycles", "-t", str(options["threads"]), "-P", os.path.abspath(__file__),
                           "--", json.dumps(options)], check=True, capture_output=True, text=True)
    text = text.stdout + text.stderr
    return options["res"] ** 2 * options["spp"] / float(re.findall(r"Render time \(without synchronization\): ([\d.]+)", text)[-1])


def tessera_arguments(options):
    return [SCENE, "--spp", str(options["spp"]), "--res", "%dx%d" % (options["res"], options["res"]), "-t", str(options["threads"]), "--aov", "beauty",
            "--set", "film.filter=box", "--set", "film.filter_width_px=1", "--set", "render.max_depth=5"]


def run_tessera(program, options):
    text = subprocess.run([program, "bench", "--repeats", "1"] + tessera_arguments(options), check=True, capture_output=True, text=True).stdout
    return float(re.search(r"samples/s +([\d.]+) M", text).group(1)) * 1e6


def mean(path):
    text = subprocess.run(["oiiotool", path, "--ch", "R,G,B", "--printstats"], check=True, capture_output=True, text=True).stdout
    return [float(x) for x in re.search(r"Stats Avg: ([\d. ]+)", text).group(1).split()]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tessera", default=os.path.join(ROOT, "build", "release", "bin", "tessera"))
    for name, value in (("spp", 64), ("res", 320), ("threads", 2), ("rounds", 5)):
        parser.add_argument("--" + name, type=int, default=value)
    a = parser.parse_args()
    options = {"spp": a.spp, "res": a.res, "threads": a.threads}
    ours, theirs = [], []
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(a.rounds):
            theirs.append(run_cycles(options, folder))
            ours.append(run_tessera(a.tessera, options))
        picture = os.path.join(folder, "tessera.exr")
        subprocess.run([a.tessera, "render", "-q", "-o", picture] + tessera_arguments(options), check=True)
        means = mean(picture), mean(os.path.join(folder, "cycles.exr"))
    ratios = [o / t for o, t in zip(ours, theirs)]
    for name, values in (("tessera", ours), ("Cycles", theirs)):
        print("%-8s %.3f Msamples/s (min %.3f, max %.3f)" % (name, statistics.median(values) * 1e-6, min(values) * 1e-6, max(values) * 1e-6))
    print("ratio    %.2f (min %.2f, max %.2f, %d rounds)" % (statistics.median(ratios), min(ratios), max(ratios), a.rounds))
    print("means    " + " ".join("%.4f" % (o / t) for o, t in zip(*means)) + "  (tessera over Cycles, R G B)")


if __name__ == "__main__":
    try:
        import bpy  # noqa: F401
        inside_blender(json.loads(sys.argv[sys.argv.index("--") + 1]))
    except ImportError:
        main()
