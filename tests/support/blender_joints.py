"""blender --background --factory-startup --python blender_joints.py -- FILE JOINTS.npz [PERSON]

Opens a .glb or a .bvh in Blender and prints how far, in metres, any of its joints is from those of the clip in the .npz, in any
frame. The .npz holds one clip; of its persons a .bvh has the one given, from 0.
"""
import builtins
import sys

import bpy
import numpy

# Debian 12's Blender has importers that ask for what its Python and NumPy no longer know.
if not hasattr(numpy, "bool"):
    numpy.bool = bool
plain_open = builtins.open
builtins.open = lambda file, mode="r", *more, **named: plain_open(file, mode.replace("U", ""), *more, **named)

file, joints_file, *person = sys.argv[sys.argv.index("--") + 1:]
npz = numpy.load(joints_file)
joints, names = npz[str(npz["clips"][0])], [str(name) for name in npz["names"]]
frames, persons, _, _ = joints.shape

bpy.ops.object.select_all(action="SELECT")
bpy.ops.object.delete()
scene = bpy.context.scene
scene.render.fps = round(float(npz["fps"]))
is_bvh = file.endswith(".bvh")
if is_bvh:
    bpy.ops.import_anim.bvh(filepath=file, global_scale=0.01, frame_start=1, update_scene_fps=False)
else:
    bpy.ops.import_scene.gltf(filepath=file)
bones = {}
for armature in (o for o in bpy.data.objects if o.type == "ARMATURE"):
    for bone in armature.pose.bones:
        bones[bone.name] = (armature, bone)


def name_in_file(p, joint):
    if is_bvh:
        return "".join(c if c.isascii() and c.isprintable() and c not in " {}" else "_" for c in names[joint])
    return f"p{p + 1} {names[joint]}" if persons > 1 else names[joint]


furthest, compared = 0.0, 0
for t in range(frames):
    scene.frame_set(t + 1 if is_bvh else t)  # of a .bvh the first frame is 1 at the least
    for p in [int(person[0])] if person else range(persons):
        for j in range(len(names)):
            armature, bone = bones[name_in_file(p, j)]
            x, y, z = armature.matrix_world @ bone.head  # Blender's z is up
            furthest = numpy.maximum(furthest, numpy.linalg.norm(joints[t, p, j] - (x, z, -y)))  # NaN where any is
            compared += 1
print(f"compared {compared} joints, furthest {furthest:.9f} m")
