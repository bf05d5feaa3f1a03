# SPDX-License-Identifier: MIT
"""Cairn for Python: ctypes and NumPy over <cairn/cairn.h>. Arrays have the layout of its structs,
and are solved where they lie."""
import ctypes
import ctypes.util

import numpy

VERSION = (0, 2, 0)
WORLD = -1
OK = 0
UNLIMITED, TIME, WORK = range(3)
PGS, PSOR, PGS_SM = range(3)

f32, i32 = "f4", "i4"
VELOCITY = numpy.dtype([("linear", f32, 3), ("angular", f32, 3)], align=True)
BODY = numpy.dtype([("invMass", f32), ("invInertia", f32, (3, 3)), ("linearFactor", f32, 3),
                    ("velocity", VELOCITY), ("impulse", f32, 3), ("angularImpulse", f32, 3),
                    ("strain", f32), ("id", "u8")], align=True)
POINT = numpy.dtype([("armA", f32, 3), ("armB", f32, 3), ("normal", f32, 3), ("tangent", f32, 3),
                     ("bias", f32), ("restitution", f32), ("friction", f32), ("compliance", f32)],
                    align=True)
IMPULSE = numpy.dtype([("normal", f32), ("tangential", f32, 2), ("heading", f32),
                       ("direction", f32, 3)], align=True)
TWIST = numpy.dtype([("spinning", f32), ("rolling", f32), ("mostSpinning", f32),
                     ("mostRolling", f32)], align=True)
TWIST_IMPULSE = numpy.dtype([("spinning", f32), ("rolling", f32, 2)], align=True)
MANIFOLD = numpy.dtype([("bodyA", i32), ("bodyB", i32), ("firstPoint", i32), ("points", "i1"),
                        ("tangents", "i1"), ("soft", "?"), ("twists", "?"), ("speeds", "u1"),
                        ("sweepLimit", i32)], align=True)
JOINT_ROW = numpy.dtype([("linearA", f32, 3), ("target", f32), ("angularA", f32, 3),
                         ("compliance", f32), ("linearB", f32, 3), ("lo", f32),
                         ("angularB", f32, 3), ("hi", f32)], align=True)
JOINT = numpy.dtype([("bodyA", i32), ("bodyB", i32), ("firstRow", i32), ("rows", i32),
                     ("bounded", "u4"), ("angular", "u4"), ("errors", "u4"), ("damping", f32),
                     ("soft", "?"), ("opposite", "?"), ("sweepLimit", i32)], align=True)


def struct(name, *fields):
    return type(name, (ctypes.Structure,), {"_fields_": list(fields)})


def counts(names):
    return [(name, ctypes.c_int32) for name in names.split()]


pointer, c_int, c_i32, c_i64 = ctypes.c_void_p, ctypes.c_int, ctypes.c_int32, ctypes.c_int64
c_double, c_bool = ctypes.c_double, ctypes.c_bool
Problem = struct("Problem", *[(name, pointer) for name in
                              "bodies manifolds points twists joints jointRows".split()],
                 *counts("bodyCount manifoldCount pointCount twistCount jointCount jointRowCount"),
                 ("bounceSpeed", ctypes.c_float), ("timeStep", ctypes.c_float))
Solution = struct("Solution", *[(name, pointer) for name in
                                "points twists jointRows velocities".split()])
Settings = struct("Settings", ("method", c_int), ("path", c_int), ("kGs", c_i32), ("kSm", c_i32),
                  ("steps", c_bool), ("relax", c_bool), ("maxSweeps", c_i32),
                  ("geometricStiffness", c_bool), ("substeps", c_i32),
                  ("tolerance", c_double), ("quietSpeed", c_double), ("unitsPerMetre", c_double),
                  ("budgetKind", c_int), ("budget", c_i64), ("minSweeps", c_i32),
                  ("threads", c_i32), ("submit", pointer), ("context", pointer),
                  ("allocate", pointer), ("free", pointer), ("memoryContext", pointer))
Report = struct("Report", ("status", c_int), *counts("badBody badManifold badJoint"),
                ("stop", c_int), ("path", c_int), ("residualMax", c_double),
                ("residualAngular", c_double),
                *counts("sweeps factorisations stepsAccepted stepsRestored guarded islandCount"),
                ("work", c_i64), ("elapsed", c_i64),
                *[(name, c_double * 2) for name in ("depth", "gap", "angle")])  # asked, done
Island = struct("Island", *counts("firstBody bodies rows quiet"), ("speed", c_double),
                ("spin", c_double), *counts("sweeps factorisations stepsAccepted stepsRestored"),
                ("stop", c_int), ("guarded", c_bool), ("residualBefore", c_double),
                ("residual", c_double), ("residualAngular", c_double), ("strain", c_double),
                *counts("strainedBody enoughSubsteps"))
Layout = struct("Layout", *[(name, ctypes.c_uint32) for name in (
    "version body contactPoint contactImpulse contactTwist twistImpulse manifold jointRow joint "
    "problem solution settings report island").split()])


def layout():
    """The structs as they are here: the library compares them with its own."""
    version = VERSION[0] << 16 | VERSION[1] << 8 | VERSION[2]
    arrays = (BODY, POINT, IMPULSE, TWIST, TWIST_IMPULSE, MANIFOLD, JOINT_ROW, JOINT)
    structs = (Problem, Solution, Settings, Report, Island)
    return Layout(version, *[array.itemsize for array in arrays],
                  *[ctypes.sizeof(structure) for structure in structs])


class CairnError(Exception):
    """What a call that failed says."""


class Library:
    """libcairn-c, by its path or where the system finds it."""

    def __init__(self, path=None):
        self.c = ctypes.CDLL(path or ctypes.util.find_library("cairn-c") or "libcairn-c.so")
        self.c.cairnDescribe.restype = ctypes.c_char_p
        self.c.cairnDefaultSettings.restype = Settings
        self.c.cairnVersion.restype = ctypes.c_uint32
        for name in ("cairnDescribeReport", "cairnDescribeSettings", "cairnValidateStrictly"):
            getattr(self.c, name).restype = ctypes.c_size_t
        self.c.cairnDestroySolver.argtypes = self.c.cairnFreeRecording.argtypes = [pointer]
        self.c.cairnReset.argtypes = [pointer]

    def check(self, status):
        if status != OK:
            raise CairnError(self.c.cairnDescribe(status).decode())

    def settings(self, **changes):
        """The default settings but for some: settings(maxSweeps=20, steps=False)."""
        settings = self.c.cairnDefaultSettings()
        for name, value in changes.items():
            if name not in dict(Settings._fields_):
                raise AttributeError(f"no setting {name}")
            setattr(settings, name, value)
        return settings


def default_array(dtype, count):
    """So many bodies, points, ... with the defaults of cairn.h."""
    array = numpy.zeros(count, dtype)
    if dtype == BODY:
        array["linearFactor"] = 1
    elif dtype == MANIFOLD:
        array["bodyA"] = array["bodyB"] = WORLD
        array["points"], array["tangents"], array["sweepLimit"] = 1, 2, 2**31 - 1
    elif dtype == JOINT_ROW:
        array["lo"], array["hi"] = -numpy.inf, numpy.inf
    elif dtype == JOINT:
        array["bodyA"] = array["bodyB"] = WORLD
        array["rows"], array["damping"], array["sweepLimit"] = 1, 1, 2**31 - 1
    return array


def address(array, dtype):
    if len(array) == 0:
        return None
    if array.dtype != dtype or not array.flags.c_contiguous:
        raise CairnError(f"must be a contiguous array of {dtype}")
    return array.ctypes.data


class Solver:
    def __init__(self, library, settings=None):
        self.library, self.handle = library, pointer()
        self.report = Report()
        settings = settings or library.settings()
        status = library.c.cairnCreateSolver(layout(), ctypes.byref(settings),
                                             ctypes.byref(self.handle))
        text = ctypes.create_string_buffer(200)
        library.c.cairnDescribeSettings(ctypes.byref(settings), text, ctypes.c_size_t(200))
        if status != OK and text.value:
            raise CairnError(text.value.decode())
        library.check(status)

    def __del__(self):
        if self.handle:
            self.library.c.cairnDestroySolver(self.handle)

    def reset(self):
        self.library.c.cairnReset(self.handle)

    def record_next(self, path):
        self.library.check(self.library.c.cairnRecordNext(self.handle, str(path).encode()))

    def solve(self, bodies, manifolds=(), points=(), impulses=(), joints=(), rows=(),
              row_impulses=(), bounce_speed=0.0):
        """Velocities of the bodies; impulses are read as the start, and written."""
        if len(impulses) != len(points) or len(row_impulses) != len(rows):
            raise CairnError("one impulse per point and row")
        velocities = numpy.zeros(len(bodies), VELOCITY)
        problem = Problem(address(bodies, BODY), address(manifolds, MANIFOLD),
                          address(points, POINT), None, address(joints, JOINT),
                          address(rows, JOINT_ROW), len(bodies), len(manifolds), len(points), 0,
                          len(joints), len(rows), bounce_speed)
        solution = Solution(address(impulses, IMPULSE), None,
                            address(row_impulses, numpy.dtype(f32)), address(velocities, VELOCITY))
        self.finish(self.library.c.cairnSolve(self.handle, ctypes.byref(problem),
                                              ctypes.byref(solution), ctypes.byref(self.report)))
        return velocities

    def solve_recording(self, recording):
        velocities = numpy.zeros(recording.bodies, VELOCITY)
        self.finish(self.library.c.cairnSolveRecording(
            self.handle, recording.handle, pointer(address(velocities, VELOCITY)),
            ctypes.byref(self.report)))
        return velocities

    def finish(self, status):
        if status != OK:
            text = ctypes.create_string_buffer(400)
            self.library.c.cairnDescribeReport(self.handle, text, ctypes.c_size_t(400))
            raise CairnError(text.value.decode())


class Recording:
    """A frame that cairnRecordNext(), a game on Bullet or `cairn record` wrote."""

    def __init__(self, library, path):
        self.library, self.handle = library, pointer()
        library.check(library.c.cairnLoadRecording(str(path).encode(), ctypes.byref(self.handle)))
        self.bodies = library.c.cairnRecordingBodies(self.handle)

    def __del__(self):
        if self.handle:
            self.library.c.cairnFreeRecording(self.handle)
