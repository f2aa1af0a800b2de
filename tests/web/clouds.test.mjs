// PLY, PCD and LAS, read back by three.js and copc.js; their coordinates by proj4js.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';

import { Las } from 'copc';
import proj4 from 'proj4';
import { PCDLoader } from 'three/examples/jsm/loaders/PCDLoader.js';
import { PLYLoader } from 'three/examples/jsm/loaders/PLYLoader.js';

import { bytesOf, distance, ecefOfLocal, firstGpsTime, light, TestMap } from './test_map.mjs';

let map;
before(() => {
  map = new TestMap();
});
after(() => map.remove());

const kGeocentric = '+proj=geocent +datum=WGS84 +units=m +no_defs';

/// three.js has colours in linear light.
function checkGeometry(geometry, expected, positionOf, tolerance, colorTolerance) {
  const { position, color } = geometry.attributes;
  assert.equal(position.count, expected.length);
  expected.forEach((point, i) => {
    const p = [position.getX(i), position.getY(i), position.getZ(i)];
    assert.ok(distance(p, positionOf(point)) < tolerance, `point ${i}`);
    const rgb = [color.getX(i), color.getY(i), color.getZ(i)];
    rgb.forEach((channel, c) => {
      assert.ok(Math.abs(channel - light(point.color[c])) < colorTolerance, `colour of point ${i}`);
    });
  });
}

// three.js keeps floats, which resolve half a metre at 6,000 km: the bytes are doubles all the same,
// and LAS below is read exactly.
for (const [crs, tolerance] of [['local', 1e-5], ['ecef', 0.5]]) {
  const positionOf = (point) => (crs === 'local' ? point.local : ecefOfLocal(point.local));

  test(`PLY in three.js, ${crs}`, () => {
    const loader = new PLYLoader();
    loader.setCustomPropertyNameMapping({
      range: ['range'],
      intensity: ['intensity'],
      provenance: ['camera', 'frame', 'interpolated', 'views', 'spread', 'reason'],
    });
    const geometry = loader.parse(bytesOf(map.export(`${crs}.ply`, '--crs', crs)));
    // It rounds light to 8 bits.
    checkGeometry(geometry, map.points, positionOf, tolerance, 0.51 / 255);
    const { range, intensity, provenance } = geometry.attributes;
    map.points.forEach((point, i) => {
      assert.ok(Math.abs(range.array[i] - point.range) < 1e-6);
      assert.ok(Math.abs(intensity.array[i] - point.intensity) < 1e-6);
      const read = Array.from(provenance.array.slice(6 * i, 6 * i + 6));
      const { camera, frame, interpolated, views, spread, reason } = point;
      assert.deepEqual(read, [camera, frame, interpolated, views, spread, reason]);
    });
  });

  test(`PCD in three.js, ${crs}`, () => {
    const cloud = new PCDLoader().parse(bytesOf(map.export(`${crs}.pcd`, '--crs', crs)));
    checkGeometry(cloud.geometry, map.points, positionOf, tolerance, 1e-6);
    const { intensity } = cloud.geometry.attributes;
    map.points.forEach((point, i) => {
      assert.ok(Math.abs(intensity.array[i] - point.intensity) < 1e-6);
    });
  });
}

async function readLas(path) {
  const bytes = new Uint8Array(bytesOf(path));
  const header = Las.Header.parse(bytes);
  const vlrs = await Las.Vlr.walk(async (begin, end) => bytes.slice(begin, end), header);
  const content = (user, record) => {
    const { contentOffset, contentLength } = Las.Vlr.at(vlrs, user, record);
    return bytes.slice(contentOffset, contentOffset + contentLength);
  };
  const extraBytes = Las.ExtraBytes.parse(content('LASF_Spec', 4));
  const view = Las.View.create(bytes.slice(header.pointDataOffset), header, extraBytes);
  const wkt = Buffer.from(content('LASF_Projection', 2112)).toString().replace(/\0$/, '');
  return { header, view, wkt, extraBytes };
}

/// The PROJCS of a compound CRS: proj4js takes no others.
function horizontal(wkt) {
  const begin = wkt.indexOf('PROJCS[');
  let depth = 0;
  for (let end = begin; end < wkt.length; ++end) {
    depth += { '[': 1, ']': -1 }[wkt[end]] ?? 0;
    if (wkt[end] === ']' && depth === 0) return wkt.slice(begin, end + 1);
  }
  throw new Error(`no PROJCS in ${wkt}`);
}

for (const crs of ['local', 'utm', 'ecef']) {
  test(`LAS in copc.js, ${crs}`, async () => {
    const { header, view, wkt, extraBytes } = await readLas(map.export(`${crs}.las`, '--crs', crs));
    assert.equal(`${header.majorVersion}.${header.minorVersion}`, '1.4');
    assert.equal(header.pointDataRecordFormat, 7);
    assert.equal(header.globalEncoding & 17, 17);
    assert.equal(header.pointCount, map.points.length);
    assert.equal(header.pointCountByReturn[0], map.points.length);
    assert.equal(view.pointCount, map.points.length);
    assert.equal(header.fileCreationYear, 2011);
    assert.equal(extraBytes.length, 7);
    const names = ['X', 'Y', 'Z', 'Red', 'Green', 'Blue', 'GpsTime', 'Intensity', 'Synthetic', 'ReturnNumber',
      'NumberOfReturns', 'camera', 'frame', 'range', 'interpolated', 'views', 'spread', 'reason'];
    const get = Object.fromEntries(names.map((name) => [name, view.getter(name)]));

    const min = [Infinity, Infinity, Infinity], max = [-Infinity, -Infinity, -Infinity];
    map.points.forEach((point, i) => {
      const p = [get.X(i), get.Y(i), get.Z(i)];
      p.forEach((coordinate, axis) => {
        min[axis] = Math.min(min[axis], coordinate);
        max[axis] = Math.max(max[axis], coordinate);
      });
      // proj4js reads the CRS from the file itself.
      let expected = point.local;
      if (crs === 'ecef') expected = ecefOfLocal(point.local);
      if (crs === 'utm') expected = proj4(kGeocentric, horizontal(wkt), ecefOfLocal(point.local));
      assert.ok(distance(p, expected) < 0.001, `point ${i}: ${p} instead of ${expected}`);
      assert.deepEqual([get.Red(i), get.Green(i), get.Blue(i)], point.color.map((c) => 257 * c));
      assert.ok(Math.abs(get.GpsTime(i) - (firstGpsTime + point.frame / 10)) < 1e-6);
      assert.equal(get.Intensity(i), Math.round(point.intensity * 65535));
      assert.equal(get.Synthetic(i), point.interpolated);
      assert.equal(get.ReturnNumber(i), 1);
      assert.equal(get.NumberOfReturns(i), 1);
      for (const name of ['camera', 'frame', 'interpolated', 'views', 'spread', 'reason']) {
        assert.equal(get[name](i), point[name], name);
      }
      assert.ok(Math.abs(get.range(i) - point.range) < 1e-6);
    });
    assert.ok(distance(header.min, min) < 1e-6);
    assert.ok(distance(header.max, max) < 1e-6);
  });
}
