"""Maps: the compiled class, and the parts of it that are written in Python."""
from . import _fovea
from ._fovea import Points, merge
from ._meta import Meta

__all__ = ["Map", "Points", "merge"]


class Map(_fovea.Map):
    __doc__ = _fovea.Map.__doc__

    @property
    def meta(self):
        """What the map states about itself: a Meta."""
        return Meta(self._meta)

    def _open_path(self):
        if self.closed:
            raise ValueError("the map is closed")
        return self.path

    def export(self, output, format=None, *, where="", crs="", exposure="auto", uncolored=False,
               double=False, color_depth=8, voxel=0.05, max_points=500_000, drive=None, pixel=0.05,
               utc_offset=None, force=False):
        """Writes the map in another form, as `fovea export` does, and returns an ExportedMap."""
        options = _fovea._ExportOptions()
        options.format = format or ""
        options.where = where
        options.crs = crs
        options.exposure = exposure
        options.include_uncolored = uncolored
        options.double_positions = double
        options.color_depth = color_depth
        options.voxel = voxel
        options.max_points = max_points
        if drive is not None:
            options.drive = drive
        options.pixel = pixel
        options.utc_offset = utc_offset
        options.force = force
        return _fovea._export(self._open_path(), output, options)

    def render(self, output=None, *, view="behind", eye=None, target=None, frame=None, width=1280,
               height=720, drive=None, camera=None, foreign=False, exposure="", force=False):
        """Draws a picture of the map, as `fovea render` does: height x width x 3 uint8."""
        if (eye is None) != (target is None):
            raise ValueError("eye and target belong together")
        options = _fovea._PictureOptions()
        options.view = view
        options.frame = -1 if frame is None else frame
        options.width = width
        options.height = height
        options.exposure = exposure
        if eye is not None:
            options.look(eye, target)
        return _fovea._render(self._open_path(), output, force, options, drive,
                              -1 if camera is None else camera, foreign)

    def render_drive(self, output, poses, *, cameras=None, lidar=None, rate=10.0, reach=80.0,
                     exposure="auto", threads=0, force=False):
        """Writes a drive of what cameras and a LiDAR see from poses, and returns RenderFigures."""
        return _fovea._render_drive(self._open_path(), output, poses, cameras or {}, lidar or "",
                                    rate, reach, exposure, threads, force)

    def plot_top(self, ax=None, *, where="", box=None, pixel=0.1):
        """Draws the map from above with matplotlib and returns the axes."""
        from ._plot import plot_top

        return plot_top(self.points(where, box=box), ax, pixel)
