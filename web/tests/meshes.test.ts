import { describe, expect, test } from 'vitest';
import { readGltf } from '../src/model/gltf';
import type { GltfJson } from '../src/model/gltf_file';
import { boxOf } from '../src/model/mesh';
import { decodeText, imageNameOf, readMtl } from '../src/model/mtl';
import { readObj } from '../src/model/obj';
import { readPlyMesh } from '../src/model/ply_mesh';
import { attempt, Refusal } from '../src/model/result';
import { readStl } from '../src/model/stl';
import { placesOf, readSurfaceMap } from '../src/model/surface_map';

const bytesOf = (text: string): ArrayBuffer => new TextEncoder().encode(text).buffer as ArrayBuffer;

describe('OBJ', () => {
  test('a quad becomes two triangles, a corner with two texture coordinates two vertices', () => {
    const mesh = readObj(
      'mtllib a b.mtl\nv 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nvt 0 0\nvt 1 1\n' +
        'usemtl red\nf 1/1 2/1 3/1 4/1\nusemtl blue\nf -4/2 -3/2 -2/2\n',
    );
    expect([...mesh.indices]).toEqual([0, 1, 2, 0, 2, 3, 4, 5, 6]);
    expect(mesh.libraries).toEqual(['a b.mtl']);
    expect(mesh.parts).toEqual([
      { material: 'red', first: 0, count: 6 },
      { material: 'blue', first: 6, count: 3 },
    ]);
    expect([...mesh.uvs!.slice(8)]).toEqual([1, 1, 1, 1, 1, 1]);
    expect(boxOf(mesh)).toEqual({ min: [0, 0, 0], max: [2, 2, 0] });
  });

  test.each([
    ['v 0 0\n', 'line 1'],
    ['v 0 0 nan\n', 'line 1'],
    ['v 0 0 0\nf 1 2 3\n', 'line 2'],
    ['v 0 0 0\nf 1 1\n', 'line 2'],
    ['v 0 0 0\nf 1 1 0\n', 'line 2'],
    ['v 0 0 0\nf 1 1 -2\n', 'line 2'],
  ])('%j is refused with the line number', (text, line) => {
    const result = attempt(() => readObj(text));
    expect(result.ok).toBe(false);
    if (!result.ok) expect(result.failure.what).toContain(line);
  });

  test('a file without faces is refused', () => {
    expect(() => boxOf(readObj('v 0 0 0\n'))).toThrow(Refusal);
  });

  test('texture coordinates count only if a face uses them', () => {
    const text = 'v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n';
    expect(readObj(`${text}f 1 2 3\n`).uvs).toBeUndefined();
    expect(readObj(`${text}f 1/1 2/1 3/1\n`).uvs).toBeDefined();
  });
});

describe('MTL', () => {
  test('image names of materials may have options and spaces', () => {
    const materials = readMtl(
      'newmtl a b\nKd 1 0 0.5\nmap_Kd -s 1 1 1 -clamp on my skin.png\nnewmtl c\n',
    );
    expect(materials.get('a b')).toEqual({ colour: [1, 0, 0.5], map: 'my skin.png' });
    expect(materials.get('c')).toEqual({ colour: [1, 1, 1] });
  });

  test.each([
    ['-bm 0.5 -o 1 2 skin.png', 'skin.png'],
    ['skin.png -clamp on', 'skin.png'],
    ['"my skin.png"', 'my skin.png'],
    ['a -1.png', 'a -1.png'],
    ['-dash.png', '-dash.png'],
  ])('%j names the image %j', (text, name) => {
    expect(imageNameOf(text)).toBe(name);
  });

  test('keywords have any case, lines any end, and map_Ka stands in for map_Kd', () => {
    const materials = readMtl('NEWMTL a\rMAP_KA b.png\rnewmtl c\rmap_Ka b.png\rMap_kd d.png');
    expect(materials.get('a')!.map).toBe('b.png');
    expect(materials.get('c')!.map).toBe('d.png');
  });

  test('text that is not UTF-8 is Latin-1', () => {
    expect(decodeText(Uint8Array.of(0x67, 0x72, 0xfc, 0x6e).buffer)).toBe('grün');
    expect(decodeText(bytesOf('grün'))).toBe('grün');
  });
});

describe('STL', () => {
  const triangle = [0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0];
  const binary = (head: string, count = 1) => {
    const view = new DataView(new ArrayBuffer(134));
    [...head].forEach((c, i) => view.setUint8(i, c.charCodeAt(0)));
    view.setUint32(80, count, true);
    triangle.forEach((value, i) => view.setFloat32(84 + 4 * i, value, true));
    return view.buffer;
  };

  test('a binary file is read, even if it begins with "solid"', () => {
    for (const head of ['', 'solid x'])
      expect([...readStl(binary(head)).positions]).toEqual(triangle.slice(3));
  });

  test('a text file is read', () => {
    const mesh = readStl(
      bytesOf('solid\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1e0 0\nendloop'),
    );
    expect([...mesh.positions]).toEqual(triangle.slice(3));
  });

  test('a file shorter than its header says is refused', () => {
    expect(() => readStl(binary('', 1000))).toThrow(/1000 triangles/);
    expect(() => readStl(bytesOf('solid nothing'))).toThrow(Refusal);
  });
});

/** One triangle as a binary surface map, with the stretch of each vertex; NaN means that the film does not reach it. */
function surfaceMap(stretch: number[]): ArrayBuffer {
  const head =
    'ply\nformat binary_little_endian 1.0\nelement vertex 3\n' +
    ['x', 'y', 'z', 'film_x', 'film_y', 'contact_time', 'stretch']
      .map((name) => `property double ${name}\n`)
      .join('') +
    'element face 1\nproperty list uchar int vertex_indices\nend_header\n';
  const out = new Uint8Array(head.length + 3 * 7 * 8 + 13);
  out.set(new TextEncoder().encode(head));
  const view = new DataView(out.buffer, head.length);
  const corners = [
    [0, 0, 0],
    [10, 0, 0],
    [0, 10, 0],
  ];
  corners.forEach(([x, y, z], i) =>
    [x!, y!, z!, 2 * x!, 2 * y!, 3 * i, stretch[i]!].forEach((value, k) =>
      view.setFloat64(56 * i + 8 * k, value, true),
    ),
  );
  view.setUint8(168, 3);
  [0, 1, 2].forEach((index, i) => view.setInt32(169 + 4 * i, index, true));
  return out.buffer;
}

describe('PLY', () => {
  const text =
    'ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n' +
    'property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n' +
    'property list uchar int vertex_index\nend_header\n' +
    '0 0 0 255 0 0\n1 0 0 0 255 0\n1 1 0 0 0 255\n0 1 0 9 9 9\n4 0 1 2 3\n';

  test('a text file with colours and a quad is read', () => {
    const mesh = readPlyMesh(bytesOf(text));
    expect([...mesh.indices]).toEqual([0, 1, 2, 0, 2, 3]);
    expect([...mesh.colours!.slice(0, 6)]).toEqual([255, 0, 0, 0, 255, 0]);
  });

  test.each([
    ['no header', 'hello'],
    ['more rows than bytes', text.replace('vertex 4', 'vertex 400000000')],
    ['a negative count', text.replace('vertex 4', 'vertex -4')],
    ['an unknown type', text.replace('float x', 'quad x')],
    ['missing data at the end', text.slice(0, -8)],
    ['no faces', text.replace('vertex_index', 'neighbours')],
  ])('a file with %s is refused', (_, broken) => {
    const result = attempt(() => readPlyMesh(bytesOf(broken)));
    expect(result.ok).toBe(false);
  });

  test('texture files, coordinates of faces and numbers of textures are read', () => {
    const file =
      'ply\nformat ascii 1.0\ncomment TextureFile my skin.png\ncomment TextureFile b.png\n' +
      'element vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 3\n' +
      'property list uchar int vertex_indices\nproperty list uchar float texcoord\n' +
      'property int texnumber\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n' +
      '3 0 1 2 6 0 0 1 0 1 1 1\n4 0 1 2 3 8 0 0 0.5 0 0.5 1 0 1 0\n3 0 1 3 0 1\n';
    const mesh = readPlyMesh(bytesOf(file));
    expect([...mesh.materials!.values()].map(({ map }) => map)).toEqual(['my skin.png', 'b.png']);
    expect(mesh.parts).toEqual([
      { material: 'b.png', first: 0, count: 6 },
      { material: 'my skin.png', first: 6, count: 6 },
    ]);
    expect([...mesh.indices]).toEqual([0, 1, 2, 9, 10, 11, 3, 4, 5, 6, 7, 8]);
    expect([...mesh.positions.slice(24, 27)]).toEqual([0, 1, 0]);
    expect([...mesh.uvs!]).toEqual([
      ...[0, 0, 1, 0, 1, 1],
      ...[0, 0, 0.5, 0, 0.5, 1, 0, 0, 0.5, 1, 0, 1],
      ...[0, 0, 0, 0, 0, 0],
    ]);
  });

  test('a surface map has film positions, times and stretch', () => {
    const map = readSurfaceMap(surfaceMap([1, 1.5, 4]));
    expect([...map.film_mm]).toEqual([0, 0, 20, 0, 0, 20]);
    expect([...map.stretch]).toEqual([1, 1.5, 4]);
    expect(map.contactMax_s).toBe(6);
    expect(map.box.max).toEqual([10, 10, 0]);
  });

  test('warnings select the triangles that they are about', () => {
    const torn = readSurfaceMap(surfaceMap([1, 1.5, 4]));
    const bare = readSurfaceMap(surfaceMap([1, NaN, 1]));
    const flat = (v: readonly [number, number, number]) => v[2];
    expect(placesOf('film_torn', torn, { tear: 3 }, flat)).toEqual([0]);
    expect(placesOf('film_torn', torn, { tear: 5 }, flat)).toEqual([]);
    expect(placesOf('parts_not_reached', bare, { tear: 3 }, flat)).toEqual([0]);
    expect(placesOf('parts_not_reached', torn, { tear: 3 }, flat)).toEqual([]);
    expect(placesOf('theta_clamped', torn, { tear: 3 }, flat)).toEqual([0]);
    expect(placesOf('theta_clamped', torn, { tear: 3 }, (v) => -v[2])).toEqual([]);
    expect(placesOf('face_uvs_ignored', torn, { tear: 3 }, flat)).toEqual([]);
  });

  test('an incomplete map and any other PLY are refused', () => {
    expect(() => readSurfaceMap(surfaceMap([1, 1, 1]).slice(0, -1))).toThrow(Refusal);
    expect(() => readSurfaceMap(bytesOf(text))).toThrow(Refusal);
  });
});

describe('glTF', () => {
  const kCorners = [0, 0, 0, 1, 0, 0, 0, 1, 0];
  const json = (more: Partial<GltfJson> = {}): GltfJson => ({
    scenes: [{ nodes: [0] }],
    nodes: [{ mesh: 0 }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0 }, material: 0 }] }],
    materials: [{ name: 'skin', pbrMetallicRoughness: { baseColorTexture: { index: 0 } } }],
    textures: [{ source: 0 }],
    images: [{ bufferView: 1, mimeType: 'image/jpeg' }],
    accessors: [{ bufferView: 0, componentType: 5126, count: 3, type: 'VEC3' }],
    bufferViews: [
      { buffer: 0, byteLength: 36 },
      { buffer: 0, byteOffset: 36, byteLength: 2 },
    ],
    buffers: [{ byteLength: 38 }],
    ...more,
  });
  const kNumbers = new Uint8Array([...new Uint8Array(Float32Array.from(kCorners).buffer), 7, 8]);
  const glb = (content: unknown, chunk = kNumbers): Promise<ArrayBuffer> => {
    const text = new TextEncoder().encode(JSON.stringify(content));
    const head = Uint32Array.from([0x46546c67, 2, 28 + text.length + chunk.length]);
    return new Blob([
      head,
      Uint32Array.from([text.length, 0x4e4f534a]),
      text,
      Uint32Array.from([chunk.length, 0x004e4942]),
      chunk,
    ]).arrayBuffer();
  };

  test('a GLB is read with its position and its embedded image', async () => {
    const mesh = readGltf(await glb(json({ nodes: [{ mesh: 0, translation: [5, 0, 0] }] })));
    expect(boxOf(mesh)).toEqual({ min: [5, 0, 0], max: [6, 1, 0] });
    expect([...mesh.indices]).toEqual([0, 1, 2]);
    expect(mesh.unit_mm).toBe(1000);
    const [part] = mesh.parts;
    expect(mesh.materials!.get(part!.material)!.picture).toEqual({
      bytes: new Uint8Array([7, 8]),
      type: 'image/jpeg',
    });
  });

  test('children are placed relative to their parents; mirroring keeps the outside', async () => {
    const half = Math.SQRT1_2;
    const nodes = [
      { children: [1], rotation: [0, 0, half, half], scale: [2, 2, 2] },
      { mesh: 0, scale: [-1, 1, 1], translation: [1, 0, 0] },
    ];
    const mesh = readGltf(await glb(json({ nodes })));
    const box = boxOf(mesh);
    [-2, 0, 0].forEach((value, i) => expect(box.min[i]).toBeCloseTo(value));
    [0, 2, 0].forEach((value, i) => expect(box.max[i]).toBeCloseTo(value));
    expect([...mesh.indices]).toEqual([0, 2, 1]);
  });

  test('strips and fans become triangles; points are skipped', async () => {
    const four = Uint8Array.from([...kNumbers.slice(0, 36), ...kNumbers.slice(0, 12)]);
    const of = async (mode: number) => {
      const content = json({
        meshes: [{ primitives: [{ attributes: { POSITION: 0 }, mode }] }],
        accessors: [{ bufferView: 0, componentType: 5126, count: 4, type: 'VEC3' }],
        bufferViews: [{ buffer: 0, byteLength: 48 }],
      });
      return [...readGltf(await glb(content, four)).indices];
    };
    expect(await of(5)).toEqual([0, 1, 2, 2, 1, 3]);
    expect(await of(6)).toEqual([0, 1, 2, 0, 2, 3]);
    expect(await of(0)).toEqual([]);
  });

  test.each([
    ['external data', json({ buffers: [{ uri: 'far.bin', byteLength: 38 }] }), 'another file'],
    [
      'too large a count',
      json({ accessors: [{ ...json().accessors![0]!, count: 4 }] }),
      'outside the file',
    ],
    ['compression', json({ extensionsRequired: ['KHR_draco_mesh_compression'] }), 'draco'],
    ['a node in itself', json({ nodes: [{ children: [0] }] }), 'contains itself'],
    ['a missing mesh', { meshes: 3, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0 }] }, 'mesh 0'],
    ['a value of the wrong type', { scenes: [{ nodes: 7 }] }, 'not valid glTF'],
  ])('a file with %s is refused', async (_, content, why) => {
    const whole = await glb(content);
    const result = attempt(() => readGltf(whole));
    expect(result.ok).toBe(false);
    if (!result.ok) expect(result.failure.what).toContain(why);
  });

  test('a truncated file is refused', async () => {
    const whole = await glb(json());
    for (let length = 0; length < whole.byteLength; length += 7)
      expect(attempt(() => readGltf(whole.slice(0, length))).ok, String(length)).toBe(false);
  });
});
