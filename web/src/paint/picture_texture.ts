/** Textures of pictures: linear light, premultiplied alpha, v up, with mipmaps. */
import {
  ClampToEdgeWrapping,
  GLSL3,
  LinearMipmapLinearFilter,
  Mesh,
  MirroredRepeatWrapping,
  NearestFilter,
  NoBlending,
  OrthographicCamera,
  PlaneGeometry,
  RawShaderMaterial,
  RepeatWrapping,
  SRGBColorSpace,
  Texture,
  WebGLRenderTarget,
  type WebGLRenderer,
} from 'three';
import type { Wrap } from '../model/mesh';

const kWraps = {
  repeat: RepeatWrapping,
  mirror: MirroredRepeatWrapping,
  clamp: ClampToEdgeWrapping,
} as const;
type Wraps = readonly [Wrap, Wrap];

const kVertex = /* glsl */ `
in vec3 position;
void main() {
  gl_Position = vec4(position.xy, 0.0, 1.0);
}
`;

// The source's first row is the picture's upper one.
const kFragment = /* glsl */ `
precision highp float;
uniform sampler2D source;
out vec4 texel;
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec4 straight = texelFetch(source, ivec2(at.x, textureSize(source, 0).y - 1 - at.y), 0);
  texel = vec4(straight.rgb * straight.a, straight.a);
}
`;

function sourceOf(picture: ImageBitmap): Texture {
  const source = new Texture(picture);
  source.flipY = false;
  source.colorSpace = SRGBColorSpace;
  source.generateMipmaps = false;
  source.minFilter = source.magFilter = NearestFilter;
  source.needsUpdate = true;
  return source;
}

/** Draws a picture into a texture. Averages of straight colours would be wrong at the borders of transparency. */
function premultiplied(renderer: WebGLRenderer, picture: ImageBitmap, [u, v]: Wraps) {
  // three.js scales down larger pictures in the same way.
  const longest = Math.max(picture.width, picture.height);
  const scale = Math.min(1, renderer.capabilities.maxTextureSize / longest);
  const [width, height] = [Math.floor(scale * picture.width), Math.floor(scale * picture.height)];
  const target = new WebGLRenderTarget(width, height, {
    colorSpace: SRGBColorSpace,
    generateMipmaps: true,
    minFilter: LinearMipmapLinearFilter,
    wrapS: kWraps[u],
    wrapT: kWraps[v],
    anisotropy: renderer.capabilities.getMaxAnisotropy(),
    depthBuffer: false,
  });
  const source = sourceOf(picture);
  const material = new RawShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: kVertex,
    fragmentShader: kFragment,
    uniforms: { source: { value: source } },
    blending: NoBlending,
    depthTest: false,
  });
  const square = new Mesh(new PlaneGeometry(2, 2), material);
  square.frustumCulled = false;
  const before = renderer.getRenderTarget();
  renderer.setRenderTarget(target);
  renderer.render(square, new OrthographicCamera());
  renderer.setRenderTarget(before);
  square.geometry.dispose();
  material.dispose();
  source.dispose();
  return target;
}

/** The textures of a view, one per picture and wrap. */
export class PictureTextures {
  private readonly known = new Map<ImageBitmap, Map<string, WebGLRenderTarget>>();

  constructor(private readonly renderer: WebGLRenderer) {}

  /** The texture of a picture, which continues beyond its edges as `wraps` says. */
  of(picture: ImageBitmap, wraps: Wraps = ['repeat', 'repeat']): Texture {
    let all = this.known.get(picture);
    if (!all) this.known.set(picture, (all = new Map()));
    const key = wraps.join();
    let target = all.get(key);
    if (!target) all.set(key, (target = premultiplied(this.renderer, picture, wraps)));
    return target.texture;
  }

  /** Frees the textures of all pictures but these. */
  keep(pictures: ReadonlySet<ImageBitmap>): void {
    for (const [picture, all] of this.known) {
      if (pictures.has(picture)) continue;
      for (const target of all.values()) target.dispose();
      this.known.delete(picture);
    }
  }

  dispose(): void {
    this.keep(new Set());
  }
}
