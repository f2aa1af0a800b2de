import {
  Box3, Group, Matrix4, Mesh, Points, Vector2, Vector3, type Camera, type Object3D,
  type PerspectiveCamera,
} from 'three';
import { TilesRenderer } from '3d-tiles-renderer/three';

import { MeshObject, meshMaterial } from './mesh_object';
import type { PointMaterials } from './point_material';
import { PointObject } from './point_object';
import { estimatedSpacing } from './spacing';
import {
  nearestDistance, selectError, viewpointOf, type Selection, type TileNode,
} from './tile_selection';

/** A tile of the tileset's JSON; the renderer adds to it what it needs. */
interface JsonTile {
  boundingVolume: { box: number[] };
  geometricError: number;
  children?: JsonTile[];
  content?: { uri: string };
  transform?: number[];
  parent?: JsonTile | null;
}

interface JsonTileset {
  asset: { version: string };
  root: JsonTile;
}

interface ViewError {
  inView: boolean;
  error: number;
}

/** Finer than this nobody sees (pixels). */
const finestError = 1;
const bytesPerPoint = 40;
/** Of a grid's cells each keeps one point, not just in its middle. */
const thinnedSpread = 1.15;

/** 3D Tiles whose errors stay finite where the camera is inside a tile. */
class MapTiles extends TilesRenderer {
  pixelsPerUnit = 1;
  /** Not refined any more: of their children one could not be loaded, and would be a hole. */
  readonly stuck = new Set<object>();

  // The library calls this for each tile in sight; its typings leave it out.
  calculateTileViewError(tile: JsonTile, target: ViewError): void {
    const base = TilesRenderer.prototype as unknown as {
      calculateTileViewError(tile: JsonTile, target: ViewError): void;
    };
    base.calculateTileViewError.call(this, tile, target);
    const highest = tile.geometricError * this.pixelsPerUnit / nearestDistance;
    target.error = this.stuck.has(tile) ? 0 : Math.min(target.error, highest);
    // Without points of its own it would be a hole.
    const isEmpty = !tile.content && (tile.children ?? []).length > 0;
    if (isEmpty) target.error = Infinity;
  }
}

/** A tile with its place in the frame of the root. */
interface PlacedNode extends TileNode {
  readonly T_root_tile: Matrix4;
  children: TileNode[];
}

function isTileset(tile: JsonTile): boolean {
  return tile.content !== undefined && /\.json$/.test(tile.content.uri);
}

/** The box around a box whose half axes have any directions. */
function boxAround(b: readonly number[], T_root_tile: Matrix4): Box3 {
  const center = new Vector3(b[0], b[1], b[2]).applyMatrix4(T_root_tile);
  const half = new Vector3();
  const { elements: e } = T_root_tile;
  for (const at of [3, 6, 9]) {
    const [x, y, z] = [b[at]!, b[at + 1]!, b[at + 2]!];
    half.x += Math.abs(e[0]! * x + e[4]! * y + e[8]! * z);
    half.y += Math.abs(e[1]! * x + e[5]! * y + e[9]! * z);
    half.z += Math.abs(e[2]! * x + e[6]! * y + e[10]! * z);
  }
  return new Box3(center.clone().sub(half), center.clone().add(half));
}

function nodeOf(tile: JsonTile, T_root_parent: Matrix4,
                nodes: WeakMap<JsonTile, PlacedNode>): PlacedNode {
  const T_root_tile = tile.transform ?
    T_root_parent.clone().multiply(new Matrix4().fromArray(tile.transform)) : T_root_parent;
  const node: PlacedNode = {
    T_root_tile,
    box: boxAround(tile.boundingVolume.box, T_root_tile),
    geometricError: tile.geometricError,
    children: (tile.children ?? []).map((child) => nodeOf(child, T_root_tile, nodes)),
    points: tile.content && !isTileset(tile) ? null : 0,
  };
  nodes.set(tile, node);
  return node;
}

/** Why the server did not send a file: its own words if it says them. */
async function reasonOf(response: Response): Promise<string> {
  const isText = response.headers.get('content-type')?.startsWith('text/plain') ?? false;
  const text = isText ? (await response.text()).trim() : '';
  return text !== '' && text.length < 1000 ? text : `${response.status} ${response.statusText}`;
}

/** What happens to the tiles, for those who must act on it. */
export interface TileEvents {
  changed(): void;
  /** The tileset is there. */
  begins(box: Box3): void;
  /** Not called for triangles. */
  firstTile(points: PointObject): void;
  failed(count: number, error: Error): void;
}

/** The finished map: 3D Tiles, as many as the budget allows of points or of triangles' vertices. */
export class TileLayer {
  readonly group = new Group();
  readonly cameras = new Set<number>();
  private readonly tiles: MapTiles;
  private readonly nodes = new WeakMap<JsonTile, PlacedNode>();
  private root: TileNode | null = null;
  private selection: Selection = { errorTarget: finestError, points: 0, limited: false };
  private failures = 0;
  private seenFirst = false;
  private rootFailed = false;
  private readonly size = new Vector2(1, 1);
  private readonly meshMaterial = meshMaterial();

  constructor(url: string, private readonly materials: PointMaterials,
              private readonly events: TileEvents) {
    // Whole: against an address without a folder the renderer takes the tileset itself for one.
    const rootAddress = new URL(url, document.baseURI).href;
    this.tiles = new MapTiles(rootAddress);
    this.tiles.autoDisableRendererCulling = false;
    this.tiles.registerPlugin({
      // The page works in `local`: the root's way to the earth's centre is left out, not undone,
      // so that nothing is rounded.
      async fetchData(address: string | URL, options: RequestInit) {
        const response = await fetch(address, options);
        if (!response.ok) throw new Error(await reasonOf(response));
        if (!/\.json$/.test(new URL(response.url).pathname)) return response;
        const tileset = await response.json() as JsonTileset;
        if (String(address) === rootAddress) delete tileset.root.transform;
        tileset.asset.version = '1.0';  // of 1.1 it has nothing but glTF, which the reader knows
        return tileset;
      },
    });
    this.tiles.addEventListener('load-tileset', ({ tileset }) => {
      this.addTileset((tileset as unknown as JsonTileset).root);
    });
    this.tiles.addEventListener('load-model', ({ scene, tile }) => {
      this.adopt(scene, tile as unknown as JsonTile);
      this.events.changed();
    });
    this.tiles.addEventListener('load-error', ({ tile, error }) => {
      this.rootFailed ||= tile === null;
      let above = (tile as unknown as JsonTile | null)?.parent;
      while (above && (!above.content || isTileset(above))) above = above.parent;
      if (above) this.tiles.stuck.add(above);
      this.events.failed(++this.failures, error);
    });
    this.tiles.addEventListener('needs-update', () => this.events.changed());
    this.tiles.addEventListener('tile-visibility-change', () => this.events.changed());
    this.group.add(this.tiles.group);
  }

  get isEmpty(): boolean {
    return this.root !== null && this.root.points === 0 && this.root.children.length === 0;
  }

  /** Whether there is no tile yet, and one will come. */
  get awaitsFirst(): boolean {
    return !this.seenFirst && this.loading > 0;
  }

  /** Tiles that are on their way. */
  get loading(): number {
    const { queued = 0, downloading = 0, parsing = 0 } = (this.tiles as unknown as {
      stats: Record<string, number>;
    }).stats;
    return queued + downloading + parsing + (this.root || this.rootFailed ? 0 : 1);
  }

  /** Whether all that the present view wants is drawn. */
  get settled(): boolean {
    return this.root !== null && this.loading === 0;
  }

  get limited(): boolean {
    return this.selection.limited;
  }

  get box(): Box3 | null {
    return this.root?.box ?? null;
  }

  get pointsLoaded(): number {
    let points = 0;
    this.tiles.forEachLoadedModel((scene) => {
      scene.traverse((object) => {
        if (object instanceof PointObject) points += object.pointCount;
        else if (object instanceof MeshObject) points += object.vertexCount;
      });
    });
    return points;
  }

  retryFailed(): void {
    this.failures = 0;
    this.rootFailed = false;
    this.tiles.stuck.clear();
    this.tiles.resetFailedTiles();
    this.events.changed();
  }

  /** Chooses tiles for this camera; `height` in pixels of the screen. */
  update(camera: PerspectiveCamera, width: number, height: number, budget: number): void {
    this.size.set(width, height);
    this.tiles.setCamera(camera);
    this.tiles.setResolution(camera, this.size);
    const view = viewpointOf(camera, height);
    this.tiles.pixelsPerUnit = view.pixelsPerUnit;
    if (this.root) this.select(selectError(this.root, view, budget, finestError));
    const cache = this.tiles.lruCache;
    cache.minBytesSize = Math.max(2e8, 2 * budget * bytesPerPoint);
    cache.maxBytesSize = 1.5 * cache.minBytesSize;
    this.tiles.update();
  }

  /** Also loads what another camera sees, for a picture of its own. */
  setExtraCamera(camera: Camera | null, width: number, height: number, main: Camera): void {
    for (const known of [...this.tiles.cameras]) {
      if (known !== main && known !== camera) this.tiles.deleteCamera(known);
    }
    if (!camera) return;
    this.tiles.setCamera(camera);
    this.tiles.setResolution(camera, width, height);
  }

  dispose(): void {
    this.tiles.dispose();
    this.group.removeFromParent();
  }

  /** A target that follows each small step of the camera would have tiles come and go. */
  private select(wanted: Selection): void {
    const { errorTarget } = this.tiles;
    const keep = wanted.limited && wanted.errorTarget <= errorTarget &&
      wanted.errorTarget > 0.85 * errorTarget;
    if (!keep) this.tiles.errorTarget = wanted.errorTarget;
    this.selection = wanted;
  }

  /** A tileset's root replaces the tile that refers to it. */
  private addTileset(root: JsonTile): void {
    const parent = root.parent ? this.nodes.get(root.parent) : undefined;
    const node = nodeOf(root, parent?.T_root_tile ?? new Matrix4(), this.nodes);
    if (parent) {
      parent.children = [node];
    } else {
      this.root = node;
      this.events.begins(node.box);
    }
  }

  private adopt(scene: Object3D, tile: JsonTile): void {
    const found: (Points | Mesh)[] = [];
    scene.traverse((object) => {
      if (object instanceof Points || object instanceof Mesh) found.push(object);
    });
    let points = 0;
    for (const object of found) {
      const own = object instanceof Points ? this.pointsOf(object, tile) :
        new MeshObject(object.geometry, this.meshMaterial);
      own.position.copy(object.position);
      own.quaternion.copy(object.quaternion);
      own.scale.copy(object.scale);
      object.parent!.add(own);
      object.removeFromParent();
      if (own instanceof PointObject) {
        points += own.pointCount;
        this.notePoints(own);
      } else {
        points += own.vertexCount;
      }
      this.seenFirst = true;
    }
    const node = this.nodes.get(tile);
    if (node) node.points = points;
  }

  private notePoints(points: PointObject): void {
    this.noteCameras(points);
    if (this.seenFirst) return;
    points.parent!.updateWorldMatrix(true, true);
    this.events.firstTile(points);
  }

  private pointsOf(from: Points, tile: JsonTile): PointObject {
    const position = from.geometry.getAttribute('position');
    const scale = from.getWorldScale(new Vector3()).x;
    const spacing = tile.geometricError > 0 ? thinnedSpread * tile.geometricError :
      estimatedSpacing(position.count, (i, axis) => position.getComponent(i, axis), scale, 0.25);
    return new PointObject(from.geometry, this.materials.pictureMaterial, spacing, true);
  }

  /** Which cameras coloured points is known of the points alone where no drive is at hand. */
  private noteCameras(points: PointObject): void {
    if (!points.known) return;
    const source = points.geometry.getAttribute('_source');
    const stride = Math.max(1, Math.floor(source.count / 500));
    for (let i = 0; i < source.count; i += stride) this.cameras.add(source.getX(i));
  }
}
