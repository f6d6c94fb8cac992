/** The places of a model that an engine has read. */
import type { BufferAttribute, Mesh } from 'three';
import { done, refused, type Result } from '../model/result';

/** Triangles between places, which previews map to the film. */
export interface Places {
  /** Frame O, mm: x, y, z of each place. */
  positions: Float32Array;
  /** Three places for each triangle. */
  corners: Uint32Array;
}

/** Finds the places of a binary glTF from Engine.read(). The code that reads it is loaded only now. */
export async function placesOf(glb: ArrayBuffer): Promise<Result<Places>> {
  try {
    const { GLTFLoader } = await import('three/addons/loaders/GLTFLoader.js');
    const { scene } = await new GLTFLoader().parseAsync(glb, '');
    scene.updateMatrixWorld();
    const meshes: Mesh[] = [];
    scene.traverse((one) => {
      if ('isMesh' in one) meshes.push(one as Mesh);
    });
    return done(gather(meshes));
  } catch {
    return refused('the model cannot be shown', 'Reload the page', { status: 0 });
  }
}

function gather(meshes: readonly Mesh[]): Places {
  const positions: number[] = [];
  const corners: number[] = [];
  for (const { geometry, matrixWorld } of meshes) {
    const at = geometry.getAttribute('position').clone() as BufferAttribute;
    at.applyMatrix4(matrixWorld);
    // The loader writes the names of attributes in lower case.
    const places = geometry.getAttribute('_place');
    for (const corner of geometry.index!.array) {
      const place = places.getX(corner);
      corners.push(place);
      positions[3 * place] = at.getX(corner);
      positions[3 * place + 1] = at.getY(corner);
      positions[3 * place + 2] = at.getZ(corner);
    }
  }
  return { positions: Float32Array.from(positions), corners: Uint32Array.from(corners) };
}
