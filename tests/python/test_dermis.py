"""dermis for Python: the same bits as C++ whatever the layout of arrays, errors with their fields, threads,
the oracle, and pictures: DERMIS_PROGRAM names the program to compare with."""

import os
import pathlib
import subprocess
import sys
import tempfile
import threading
import unittest

import dermis
import numpy as np

SAMPLE = str(pathlib.Path(__file__).parents[2] / "examples/data/monkey_gbuffer.exr")
HEIGHT, WIDTH = 37, 61
CAMERA = dermis.Camera.perspective(200, 210, 30, 20)


def stripe(dtype=np.float32):
    light = np.full((HEIGHT, WIDTH, 3), 0.1, dtype)
    light[:, 20:30] = 2
    return light


def depth():
    return np.full((HEIGHT, WIDTH), 50, np.float32)


def plan(**settings):
    return dermis.Plan("burley:1/0.6/0.4", images=["depth"], **settings)


class Arrays(unittest.TestCase):
    def setUp(self):
        self.plan = plan(rank=2, taps=11)
        self.expected = self.plan.run(CAMERA, 0.5, light=stripe(), depth=depth()).scattered

    def test_light_spreads(self):
        self.assertEqual(self.expected.shape, (HEIGHT, WIDTH, 3))
        self.assertEqual(self.expected.dtype, np.float32)
        # Red farthest.
        self.assertGreater(self.expected[18, 31, 0], self.expected[18, 31, 2])
        self.assertGreater(self.expected[18, 31, 2], 0.1)

    def test_layouts_give_the_same_bits(self):
        light = stripe()
        planar = np.ascontiguousarray(light.transpose(2, 0, 1)).transpose(1, 2, 0)
        upside_down = np.ascontiguousarray(light[::-1])[::-1]
        four = np.zeros((HEIGHT, WIDTH, 4), np.float32)
        four[..., :3] = light
        for same in (planar, upside_down, four[..., :3], light.astype(np.float64), light.tolist()):
            result = self.plan.run(CAMERA, 0.5, light=same, depth=depth()).scattered
            np.testing.assert_array_equal(result, self.expected)
        constant = np.broadcast_to(np.float32(50), (HEIGHT, WIDTH))
        np.testing.assert_array_equal(self.plan.run(CAMERA, 0.5, light=light, depth=constant).scattered, self.expected)

    def test_outputs_of_the_caller_are_written(self):
        out = np.zeros((HEIGHT, WIDTH, 3), np.float16)
        result = self.plan.run(CAMERA, 0.5, light=stripe(), depth=depth(), scattered=out)
        self.assertIs(result.scattered, out)
        np.testing.assert_allclose(out, self.expected, rtol=1e-3)
        beauty = np.zeros((HEIGHT, WIDTH, 3), np.float32)
        white = np.ones_like(beauty)
        with_albedo = dermis.Plan("burley:1/0.6/0.4", images=["depth", "albedo"], rank=2, taps=11)
        with_beauty = with_albedo.run(CAMERA, 0.5, light=stripe(), depth=depth(), albedo=white, beauty=beauty)
        np.testing.assert_array_equal(with_beauty.scattered, self.expected)
        np.testing.assert_allclose(with_beauty.result, self.expected - stripe(), atol=1e-6)
        self.assertEqual(result.stats["pixels_scattered"], WIDTH * HEIGHT)

    def test_materials_by_id(self):
        ids = np.ones((HEIGHT, WIDTH), np.uint8)
        ids[:, 25:] = 2
        two = dermis.Plan({1: "skin", 2: dermis.Profile("marble")}, images=["depth", "material"], pixel_mm={1: 0.125})
        for kind in (np.uint8, np.uint16, np.uint32, np.float32, np.int64):
            result = two.run(CAMERA, 0.5, light=stripe(), depth=depth(), material=ids.astype(kind)).scattered
            if kind == np.uint8:
                first = result
            np.testing.assert_array_equal(result, first)

    def test_threads_share_a_plan(self):
        results = [None] * 4

        def work(i):
            results[i] = self.plan.run(CAMERA, 0.5, light=stripe(), depth=depth()).scattered

        threads = [threading.Thread(target=work, args=(i,)) for i in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for result in results:
            np.testing.assert_array_equal(result, self.expected)

    def test_progress_may_stop_the_run(self):
        exact = dermis.Plan("burley:0.5/0.3/0.2", images=["depth"], method="exact")
        seen = []
        out = np.full((HEIGHT, WIDTH, 3), -1, np.float32)
        exact.run(CAMERA, 0.5, light=stripe(), depth=depth(), scattered=out,
                  progress=lambda share: seen.append(share) or False)
        self.assertEqual(len(seen), 1)
        self.assertTrue((out == -1).all())
        exact.run(CAMERA, 0.5, light=stripe(), depth=depth(), scattered=out, progress=seen.append)
        self.assertEqual(seen[-1], 1)
        self.assertTrue((out > 0).all())


class Errors(unittest.TestCase):
    def test_fields(self):
        with self.assertRaises(dermis.Error) as caught:
            plan(method="fast")
        error = caught.exception
        self.assertEqual((error.code, error.argument, error.seen), (2, "method", "fast"))
        self.assertEqual(str(error), "method: got fast, want separable, exact, disc")

    def test_what_is_refused(self):
        light, z = stripe(), depth()
        its_plan = plan()
        refused = [lambda: dermis.Profile("butter"), lambda: plan(speed=1), lambda: dermis.Device("no such device"),
                   lambda: dermis.Plan("skin", images=["colour"]),
                   lambda: its_plan.run(CAMERA, light=light), lambda: its_plan.run(CAMERA, depth=z),
                   lambda: its_plan.run(CAMERA, light=light, depth=z[:5]),
                   lambda: its_plan.run(CAMERA, light=light[..., 0], depth=z),
                   lambda: its_plan.run(CAMERA, light=light, depth=z, scattered=np.zeros((2, 2, 3), np.float32)),
                   lambda: its_plan.run(CAMERA, light=light, depth=z, scattered=np.zeros_like(light, np.int32)),
                   lambda: its_plan.run(CAMERA, light=light, depth=z, result=np.zeros_like(light))]
        for call in refused:
            with self.assertRaises(dermis.Error) as caught:
                call()
            self.assertTrue(caught.exception.argument and caught.exception.wanted)


class Profiles(unittest.TestCase):
    def test_functions_take_any_shape(self):
        skin = dermis.Profile("skin")
        r = np.linspace(0.1, 3, 6).reshape(2, 3)
        self.assertEqual(skin.radial(r).shape, (2, 3, 3))
        radius = skin.radius([0.3, 0.9])
        for channel in range(3):
            np.testing.assert_allclose(skin.cdf(radius)[:, channel, channel], [0.3, 0.9], rtol=1e-8)
        np.testing.assert_allclose(skin.edge(0.0), [0.5] * 3)
        self.assertTrue((skin.transmittance(1.0) < 1).all())
        self.assertIn("skin", dermis.presets())
        self.assertEqual(skin, dermis.Profile("skin"))

    def test_taps_keep_all_light(self):
        taps = dermis.Taps("marble", 0.1, rank=2, taps=17)
        self.assertEqual(taps.weights.shape, (2, 17, 3))
        np.testing.assert_array_equal(taps.weights[0].sum(axis=0), [1, 1, 1])
        self.assertEqual(taps.offsets_px[8], 0)
        self.assertLess(taps.predicted_rel_l2, 0.1)

    def test_settings_are_listed(self):
        self.assertIn("quality", dermis.settings())


class Oracle(unittest.TestCase):
    def test_a_plan_is_within_its_bounds(self):
        self.assertIn("touching", dermis.oracle.scenes())
        scene = dermis.oracle.scene("touching", 60, 40)
        materials = {1: "skin", 2: "burley:1/0.6/0.4"}
        settings = {"rank": 2, "taps": 9, "lighting": "raw"}
        expected = dermis.oracle.separable(materials, scene.camera, settings=settings, **scene.images)
        names = [name for name in scene.images if name != "light"]
        found = dermis.Plan(materials, images=names, **settings).run(scene.camera, **scene.images)
        for values, its, bound in ((found.scattered, expected.scattered, expected.scattered_bound),
                                   (found.result, expected.result, expected.result_bound)):
            self.assertTrue((np.abs(values - its) <= bound).all())
        self.assertGreater(np.abs(expected.scattered - scene.images["light"]).max(), 0.1)

    def test_exact_is_what_taps_come_near(self):
        scene = dermis.oracle.scene("step", 48, 12)
        images = {name: scene.images[name] for name in ("light", "depth")}
        exact = dermis.oracle.exact("burley:0.5/0.4/0.3", scene.camera, **images)
        self.assertIsNone(exact.result)
        few, many = (np.abs(dermis.oracle.separable("burley:0.5/0.4/0.3", scene.camera, settings={"taps": taps},
                                                    **images).scattered - exact.scattered).max() for taps in (3, 17))
        self.assertLess(many, few)

    def test_errors(self):
        with self.assertRaises(dermis.Error) as raised:
            dermis.oracle.scene("nosuch", 10, 10)
        self.assertIn("touching", raised.exception.wanted)


class Pictures(unittest.TestCase):
    def setUp(self):
        import dermis.exr

        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.picture = dermis.exr.Picture.read(SAMPLE)

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def test_roles_and_camera_of_a_renderer(self):
        roles = self.picture.roles()
        self.assertEqual((roles.renderer, roles.lighting, roles.layer), ("blender", "raw", "ViewLayer"))
        self.assertIn("albedo", roles)
        self.assertNotIn("mask", roles)
        self.assertEqual(roles["material"], [["ViewLayer.IndexMA.X"]])
        self.assertIsNone(self.picture.load(roles, "mask"))
        self.assertEqual(self.picture.load(roles, "light").shape, (540, 960, 3))
        found = self.picture.camera(roles)
        self.assertAlmostEqual(found.camera.scale_x, 1333.33, delta=0.1)
        self.assertEqual(found.warnings, [])
        other = self.picture.roles(overrides=["mask=ViewLayer.DiffCol.R"])
        self.assertIn("mask", other)

    def test_the_same_bits_as_the_program(self):
        program = os.environ["DERMIS_PROGRAM"]
        command = [program, "filter", SAMPLE, "-o", self.path("out.exr"), "--mm-per-unit", "10", "--material", "1=skin",
                   "--rank", "2", "--taps", "7", "--output-layers", "sss", "--quiet"]
        subprocess.run(command, check=True)
        expected = dermis.exr.Picture.read(self.path("out.exr"))
        roles = self.picture.roles()
        found = self.picture.camera(roles)
        images = self.picture.images(roles, found)
        del images["beauty"]
        plan = dermis.Plan({1: "skin"}, images=[name for name in images if name != "light"], rank=2, taps=7)
        scattered = plan.run(found.camera, mm_per_unit=10, **images).scattered
        self.assertEqual(len(expected.channels), 3)
        for name in expected.channels:
            np.testing.assert_array_equal(scattered[..., "RGB".index(name[-1])], expected[name])

    def test_what_is_written_is_read_again(self):
        values = np.linspace(0, 1, 540 * 960, dtype=np.float64).reshape(540, 960)
        self.picture["extra.Z"] = values
        self.assertIn("extra.Z", self.picture)
        self.picture.set_attribute("comment", "from Python")
        self.picture.write(self.path("copy.exr"), compression="zip")
        copy = dermis.exr.Picture.read(self.path("copy.exr"))
        self.assertEqual(sorted(copy.channels), sorted(self.picture.channels))
        np.testing.assert_array_equal(copy["extra.Z"], values.astype(np.float32))
        np.testing.assert_array_equal(copy["ViewLayer.Depth.Z"], self.picture["ViewLayer.Depth.Z"])
        self.assertEqual(copy.attribute("comment"), "from Python")
        self.picture.write(self.path("one.exr"), channels=["extra.Z"])
        self.assertEqual(dermis.exr.Picture.read(self.path("one.exr")).channels, ["extra.Z"])

        made = dermis.exr.Picture(5, 3)
        made["Z"] = np.arange(15).reshape(3, 5)
        made.write(self.path("made.exr"))
        np.testing.assert_array_equal(dermis.exr.Picture.read(self.path("made.exr"))["Z"], np.arange(15).reshape(3, 5))

    def test_errors_have_their_fields(self):
        def refused(code, argument, wanted, call):
            with self.assertRaises(dermis.Error) as raised:
                call()
            self.assertEqual(raised.exception.code, code)
            self.assertIn(argument, raised.exception.argument)
            self.assertIn(wanted, raised.exception.wanted)

        refused(3, "nosuch.exr", "", lambda: dermis.exr.Picture.read(self.path("nosuch.exr")))
        with open(self.path("broken.exr"), "wb") as file:
            file.write(b"no picture")
        refused(4, "broken.exr", "", lambda: dermis.exr.Picture.read(self.path("broken.exr")))
        refused(2, "renderer", "blender", lambda: self.picture.roles(renderer="nosuch"))
        refused(2, "role", "albedo", lambda: self.picture.load(self.picture.roles(), "nosuch"))
        refused(2, "values", "(540, 960)", lambda: self.picture.__setitem__("Z", np.zeros((2, 2))))
        refused(2, "size", "1x1", lambda: dermis.exr.Picture(0, 5))
        refused(6, "none", "", lambda: self.picture.write(self.path("none/out.exr")))


if __name__ == "__main__":
    print("dermis", dermis.__version__, "on", dermis.Device().info.name, file=sys.stderr)
    unittest.main()
