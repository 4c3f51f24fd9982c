"""The filter in plain double precision, pixel by pixel: slow, to learn from and to check against.

    scene = dermis.oracle.scene("spheres", 160, 90)
    truth = dermis.oracle.exact("skin", scene.camera, **scene.images).scattered
"""

from ._core import oracle as _oracle

Reference, Scene = _oracle.Reference, _oracle.Scene
disc, exact, scene, scenes, separable = _oracle.disc, _oracle.exact, _oracle.scene, _oracle.scenes, _oracle.separable

__all__ = ["Reference", "Scene", "disc", "exact", "scene", "scenes", "separable"]
