// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "draw/shaders.h"

// Source texts of the shaders.
namespace throng::draw::shaders {
namespace {

constexpr const char* kHead = R"(#version 300 es
precision highp float;
precision highp int;
precision highp sampler2DArray;
precision highp usampler2D;
precision highp sampler2DShadow;
uniform mat4 clip_from_world;
uniform vec3 eye;
uniform vec3 to_sun;
)";

// A low sun in a clear sky: warm light, blue shade, and haze that takes far things into the sky.
constexpr const char* kLight = R"(
uniform float haze;  // Per metre.
const vec3 kSun = vec3(1.45, 1.28, 1.02);
const vec3 kSkyLight = vec3(0.34, 0.42, 0.54);
const vec3 kGroundLight = vec3(0.22, 0.20, 0.18);
vec3 sky_colour(vec3 towards) {
  float high = clamp(towards.y, 0.0, 1.0);
  return mix(vec3(0.70, 0.77, 0.83), vec3(0.20, 0.40, 0.72), 1.0 - (1.0 - high) * (1.0 - high));
}
vec3 lit(vec3 albedo, vec3 normal, float in_sun) {
  float sun = max(dot(normal, to_sun), 0.0) * in_sun;
  vec3 around = mix(kGroundLight, kSkyLight, 0.5 + 0.5 * normal.y);
  return albedo * (kSun * sun + around);
}
vec4 shown_in(vec3 colour, float share) {
  vec3 hazy = mix(colour, vec3(0.70, 0.77, 0.83), share);
  return vec4(sqrt(clamp(hazy, 0.0, 1.0)), 1.0);
}
vec4 shown(vec3 colour, vec3 from_eye) {
  return shown_in(colour, 1.0 - exp(-haze * length(from_eye)));
}
)";

// The share of the sun that reaches a point: nine samples of the shadow map.
constexpr const char* kSunlit = R"(
uniform mat4 sun_from_world;
uniform sampler2DShadow sun_depth;
uniform float sun_texel;
float sunlit(vec3 p) {
  vec4 c = sun_from_world * vec4(p, 1.0);
  vec3 at = c.xyz * 0.5 + 0.5;
  if (any(lessThan(at, vec3(0.0))) || any(greaterThan(at, vec3(1.0)))) return 1.0;
  float sum = 0.0;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x)
      sum += textureLod(sun_depth, vec3(at.xy + vec2(x, y) * sun_texel, at.z), 0.0);
  return sum / 9.0;
}
// One sample, which the card filters: for what lies fully in the sun or in the shade.
float sunlit_once(vec3 p) {
  vec4 c = sun_from_world * vec4(p, 1.0);
  vec3 at = c.xyz * 0.5 + 0.5;
  if (any(lessThan(at, vec3(0.0))) || any(greaterThan(at, vec3(1.0)))) return 1.0;
  return textureLod(sun_depth, at, 0.0);
}
)";

// Bodies are upright, or each has an axis of its own.
constexpr const char* kUpright = "\n";
constexpr const char* kLeans = R"(
#define LEANS
vec3 axis;
// As in lean.h: the smallest rotation that turns straight up to the axis.
vec3 leaned(vec3 v) {
  if (axis.y < -0.999999) return vec3(v.x, -v.y, -v.z);
  vec3 by = vec3(axis.z, 0.0, -axis.x), turned = cross(by, v);
  return v + turned + cross(by, turned) / (1.0 + axis.y);
}
// To the right, as an eye in that direction sees a body.
vec3 right_of(vec3 towards) {
  vec3 side = cross(axis, towards);
  float size = length(side);
  return size > 1e-4 ? side / size : leaned(vec3(1.0, 0.0, 0.0));
}
)";
const char* lean_of(Leaning leaning) { return leaning == Leaning::kYes ? kLeans : kUpright; }

// Where two levels of detail overlap, each shows the pixels that the other leaves out: more and
// more of a pattern of 4 x 4.
constexpr const char* kFade = R"(
uniform vec2 mesh_range;   // Views begin and meshes end [m].
uniform vec2 point_range;  // Points begin and views end [m].
float share_beyond(vec2 range, float far) {
  return clamp((far - range.x) / max(range.y - range.x, 1e-3), 0.0, 1.0);
}
)";
constexpr const char* kPattern = R"(
float threshold() {
  ivec2 p = ivec2(gl_FragCoord.xy) & 3;
  int q = p.x ^ p.y;
  int rank = (q & 1) << 3 | (p.y & 1) << 2 | (q & 2) | p.y >> 1;
  return (float(rank) + 0.5) / 16.0;
}
)";

// The outfit of an avatar: one of twelve colours for each part, by four bits. What it wears over
// its body has a colour of its own.
constexpr const char* kOutfit = R"(
uniform usampler2D looks;  // By look: head, chest and legs of a point, the outfit; below, parts.
uniform int worn;          // 0: the body; else a WornKind plus one.
uint outfit_of(uint look) {
  if (worn < 2) return texelFetch(looks, ivec2(int(look), 0), 0).w;  // Hair is as the body's.
  uint colours = texelFetch(looks, ivec2(int(look), 1), 0).x;
  return (colours >> uint(4 * (worn - 1)) & 15u) * 0x11111111u;
}
)";
constexpr const char* kClothes = R"(
uniform vec3 wardrobe[72];
vec3 cloth(uint part, uint outfit) {
  return wardrobe[part * 12u + (outfit >> (4u * part) & 15u)];
}
uniform float part_bright[6];  // What the atlas has, on the mean of each part.
// Keeps the part's own lightness, replaces its hue.
vec3 dressed(vec3 own, uint part, uint outfit) {
  if (part == 0u) return own;
  float relief = clamp(dot(own, vec3(0.30, 0.59, 0.11)) / part_bright[part], 0.4, 1.7);
  return min(cloth(part, outfit) * relief, 0.95);
}
)";

// Which avatar and which corner a vertex is, and the rectangle that shows it. Pulled from textures
// by number: no attributes to step per instance, which software drivers do slowly.
constexpr const char* kPull = R"(
uniform usampler2D instances;
uniform usampler2D views;
uniform int first;
uniform float side;    // Of a view [m].
uniform float pixels;  // Along a view's side.
uniform vec2 page;     // [texels]
struct Corner {
  vec3 feet;
  vec2 offset;  // From the middle of the view, right and up [m].
  vec3 texel;   // x, y, page.
  float flip;   // -1: left and right are exchanged.
  uint look;
};
Corner pull() {
#ifdef LEANS
  int number = (gl_VertexID >> 2) * 2 + first, k = gl_VertexID & 3;
  axis = uintBitsToFloat(texelFetch(instances, ivec2((number & 2047) + 1, number >> 11), 0).xyz);
#else
  int number = (gl_VertexID >> 2) + first, k = gl_VertexID & 3;
#endif
  uvec4 data = texelFetch(instances, ivec2(number & 2047, number >> 11), 0);
  int view = int(data.w & 0xfffffu) * 2;
  uvec4 place = texelFetch(views, ivec2(view & 1023, view >> 10), 0);
  uvec4 part = texelFetch(views, ivec2((view & 1023) + 1, view >> 10), 0);
  vec2 at = vec2(float(k & 1), float(k >> 1)) * vec2(place.zw);
  Corner c;
  c.feet = uintBitsToFloat(data.xyz);
  c.flip = (data.w >> 20 & 1u) == 1u ? -1.0 : 1.0;
  c.offset = (vec2(part.xy) + at - 0.5 * pixels) * vec2(c.flip, -1.0) * (side / pixels);
  c.texel = vec3((vec2(place.xy) + at) / page, float(part.z));
  c.look = data.w >> 21;
  return c;
}
)";

// A card that faces the eye, `offset` from its middle.
constexpr const char* kCard = R"(
uniform float centre;  // Over the feet [m].
flat out vec3 right, up, towards;
flat out uint outfit;
flat out float in_sun;
flat out float shown_from, shown_to;  // The thresholds between which it is shown.
uniform float haze;
uniform float worn_ahead;  // Of what is worn: nearer than where it is [m].
flat out float haze_share;
out vec2 depth;             // z and w of where the card is,
flat out vec2 depth_ahead;  // and of a metre towards the eye.
out float height;
void stand(vec3 feet, vec2 offset, uint look) {
#ifdef LEANS
  vec3 middle = feet + axis * centre;
  towards = normalize(eye - middle);
  right = right_of(towards);
#else
  vec3 middle = feet + vec3(0.0, centre, 0.0);
  towards = normalize(eye - middle);
  float flat_length = length(towards.xz);
  right = flat_length > 1e-4 ? vec3(towards.z, 0.0, -towards.x) / flat_length : vec3(1.0, 0.0, 0.0);
#endif
  up = cross(towards, right);
  vec3 world = middle + right * offset.x + up * offset.y;
  height = offset.y + centre;
  outfit = outfit_of(look);
  in_sun = sunlit_once(middle + to_sun * 0.9);  // In front of its own shadow.
  float far = length(eye - middle);
  shown_from = 1.0 - (mesh_range.y > 0.0 ? share_beyond(mesh_range, far) : 1.0);
  shown_to = 1.0 - share_beyond(point_range, far);
  haze_share = 1.0 - exp(-haze * far);
  gl_Position = clip_from_world * vec4(world, 1.0);
  depth_ahead = (clip_from_world * vec4(towards, 0.0)).zw;
  depth = gl_Position.zw + depth_ahead * worn_ahead;
}
)";

// What a texel of a figure shows, and where.
constexpr const char* kFigure = R"(
flat in vec3 right, up, towards;
flat in uint outfit;
flat in float in_sun;
flat in float shown_from, shown_to;
flat in float haze_share;
in vec2 depth;
flat in vec2 depth_ahead;
in float height;
uniform sampler2DArray albedo;
uniform sampler2DArray detail;
uniform float side;          // Of a view [m].
out vec4 colour;
void show(vec3 texel, vec3 right_of_texels) {
  // Not filtered: a texel is of one part, and its colour is not that of the part beside it.
  // The page is rounded, because a number that all corners share can come out a little smaller.
  ivec3 at = ivec3(vec2(textureSize(detail, 0).xy) * texel.xy, int(texel.z + 0.5));
  vec4 stored = texelFetch(albedo, at, 0);
  vec4 d = texelFetch(detail, at, 0);
  // The depth of the body, not of the card, so that it is cut where it meets a wall or a stair. A
  // texel has its depth to 7 cm, so it is drawn 5 cm nearer; else soles would sink into the ground.
  uint mask = uint(d.z * 255.0 + 0.5);
  float in_front = (float(mask & 31u) - 16.0) / 30.0 * side + 0.05;
  vec2 zw = depth + depth_ahead * in_front;
  gl_FragDepth = clamp(0.5 * zw.x / zw.y + 0.5, 0.0, 1.0);
  vec2 lateral = (d.xy * 255.0 - 128.0) / 127.0;
  vec3 n = normalize(right_of_texels * lateral.x + up * lateral.y +
                     towards * sqrt(max(0.04, 1.0 - dot(lateral, lateral))));
  uint part = mask >> 5;
  vec3 own = stored.rgb * stored.rgb;
  own = dressed(own, part, outfit);
  float shade = mix(0.72, 1.0, smoothstep(0.0, 0.7, height));  // Less light near the ground.
  colour = shown_in(lit(own, n, in_sun) * shade, haze_share);
}
)";

// Pieces of the scene shaders that both kinds share: with materials and without.
constexpr const char* kSceneInputs = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 face;
layout(location = 2) in uint edges_tint;
out vec3 world;
out vec3 corner;
flat out vec3 normal;
flat out uint kind;
)";
constexpr const char* kSceneVertex = R"(
  world = position;
  normal = face;
  kind = edges_tint;
  int k = gl_VertexID % 3;
  corner = vec3(k == 0, k == 1, k == 2);
  gl_Position = clip_from_world * vec4(position, 1.0);
)";
constexpr const char* kSceneOutputs = R"(
in vec3 world;
in vec3 corner;
flat in vec3 normal;
flat in uint kind;
uniform float bias;
uniform float soft;      // 1: nine samples of the shadow map, 0: one.
uniform float cut;
uniform float edges;     // How dark.
uniform float edge_wide; // [px of this target]
uniform float prop;      // 1: a temporary object.
out vec4 colour;
)";
constexpr const char* kEdges = R"(
// How much of the pixel an edge covers. Far away, where triangles are small, edges fade.
float edge_cover() {
  vec3 a_pixel = fwidth(corner);
  vec3 cover = clamp(edge_wide + 0.5 - corner / max(a_pixel, 1e-6), 0.0, 1.0);
  cover *= 1.0 - smoothstep(0.05, 0.3, a_pixel);
  vec3 is_edge = vec3(kind & 1u, kind >> 1u & 1u, kind >> 2u & 1u);
  cover *= is_edge;
  return max(cover.x, max(cover.y, cover.z));
}
)";
constexpr const char* kFlatColours = R"(
  float edge = edge_cover();
  if (world.y > cut) discard;
  float tint = float(kind >> 3u);
  vec3 from_eye = world - eye;
  vec3 n = normalize(normal);
  if (dot(n, from_eye) > 0.0) n = -n;
  vec3 wall = mix(vec3(0.62, 0.52, 0.42), vec3(0.56, 0.57, 0.58), (tint - 1.0) / 30.0);
  vec3 floor_colour = vec3(0.42, 0.41, 0.39);
  if (tint < 0.5) floor_colour = vec3(0.33, 0.35, 0.32);  // The ground around the scene.
  vec3 albedo = mix(wall, floor_colour, smoothstep(0.5, 0.8, abs(n.y)));
  albedo = mix(albedo, vec3(0.72, 0.42, 0.12), prop);
)";
constexpr const char* kSceneFragment = R"(
  float in_sun = 0.0;
  if (dot(n, to_sun) > 0.0) {
    vec3 before = world + n * bias;
    in_sun = soft > 0.5 ? sunlit(before) : sunlit_once(before);
  }
  colour = shown(lit(albedo, n, in_sun) * (1.0 - edges * edge), from_eye);
)";

// Attributes of materials: see SurfaceCorner.
constexpr const char* kSurfaceInputs = R"(
layout(location = 3) in vec2 place_of;
layout(location = 4) in vec4 paint_of;
layout(location = 5) in uvec2 look_of;
out vec2 place;
flat out vec4 paint;
flat out uvec2 surface;  // Look, threshold.
)";
constexpr const char* kSurfaceVertex = R"(
  place = place_of;
  paint = paint_of;
  surface = uvec2(look_of.x, look_of.y & 255u);
)";
constexpr const char* kSurfaceOutputs = R"(
in vec2 place;
flat in vec4 paint;
flat in uvec2 surface;
uniform sampler2DArray pictures;
// Roots of the light, and how opaque.
vec4 painted() {
  if (surface.x < 2u) return paint;
  return paint * texture(pictures, vec3(place, float(surface.x - 2u)));
}
bool see_through(float opaque, float rank) {
  if (surface.y == 0u) return false;
  return opaque < (surface.y == 255u ? rank : float(surface.y) / 255.0);
}
)";

}  // namespace

// A grid of 8 x 64 rectangles: colours are computed at their corners, as a sky changes slowly and a
// processor that draws has many pixels to fill.
std::string sky_vertex() {
  return std::string(kHead) + kLight + R"(
uniform vec3 right, up, forward;  // Scaled to the edges of the picture.
out vec3 root;
void main() {
  int cell = gl_VertexID / 6, corner = gl_VertexID % 6;
  int k = corner < 3 ? corner : corner == 3 ? 2 : corner == 4 ? 1 : 3;
  vec2 at = vec2(float((cell & 7) + (k & 1)) / 4.0, float((cell >> 3) + (k >> 1)) / 32.0) - 1.0;
  root = sqrt(sky_colour(normalize(forward + right * at.x + up * at.y)));
  gl_Position = vec4(at, 1.0, 1.0);
}
)";
}

std::string sky_fragment() {
  return std::string(kHead) + R"(
in vec3 root;
out vec4 colour;
void main() { colour = vec4(root, 1.0); }
)";
}

std::string scene_vertex() {
  return std::string(kHead) + kSceneInputs + "void main() {" + kSceneVertex + "}\n";
}

// Flat colours: floors are light, walls vary a little from part to part.
std::string scene_fragment() {
  return std::string(kHead) + kLight + kSunlit + kSceneOutputs + kEdges + "void main() {" +
         kFlatColours + kSceneFragment + "}\n";
}

std::string surface_vertex() {
  return std::string(kHead) + kSceneInputs + kSurfaceInputs + "void main() {" + kSceneVertex +
         kSurfaceVertex + "}\n";
}

// Edges separate areas of one colour; textured surfaces need them less.
std::string surface_fragment() {
  return std::string(kHead) + kLight + kSunlit + kPattern + kSceneOutputs + kSurfaceOutputs +
         kEdges + "void main() {" + kFlatColours + R"(
  vec4 own = painted();
  if (see_through(own.a, threshold())) discard;
  if (surface.x > 0u) albedo = own.rgb * own.rgb;
  if (surface.x > 1u) edge *= 0.4;
)" + kSceneFragment +
         "}\n";
}

std::string depth_vertex() {
  return std::string(kHead) + R"(
layout(location = 0) in vec3 position;
out float height;
void main() {
  height = position.y;
  gl_Position = clip_from_world * vec4(position, 1.0);
}
)";
}

std::string depth_fragment() {
  return std::string(kHead) + R"(
in float height;
uniform float cut;
void main() {
  if (height > cut) discard;
}
)";
}

std::string surface_depth_vertex() {
  return std::string(kHead) + R"(
layout(location = 0) in vec3 position;
out float height;
)" + kSurfaceInputs +
         "void main() {\n  height = position.y;" + kSurfaceVertex +
         "  gl_Position = clip_from_world * vec4(position, 1.0);\n}\n";
}

// A surface that is more than half transparent casts no shadow.
std::string surface_depth_fragment() {
  return std::string(kHead) + kSurfaceOutputs + R"(
in float height;
uniform float cut;
void main() {
  vec4 own = painted();
  if (height > cut || see_through(own.a, 0.5)) discard;
}
)";
}

std::string furthest_vertex() {
  return std::string(kHead) + R"(
void main() {
  gl_Position = vec4(vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) * 4.0 - 1.0, 0.0, 1.0);
}
)";
}

std::string furthest_fragment() {
  return std::string(kHead) + R"(
precision highp sampler2D;
uniform sampler2D depth;
out uvec4 bits;
void main() {
  ivec2 first = ivec2(gl_FragCoord.xy) * 8, last = textureSize(depth, 0) - 1;
  float far = 0.0;
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x)
      far = max(far, texelFetch(depth, min(first + ivec2(x, y), last), 0).r);
  bits = uvec4(floatBitsToUint(far), 0u, 0u, 0u);
}
)";
}

std::string impostor_vertex(Leaning leaning) {
  return std::string(kHead) + lean_of(leaning) + kSunlit + kPull + kFade + kOutfit + kCard + R"(
out vec3 texel;
void main() {
  Corner c = pull();
  stand(c.feet, c.offset, c.look);
  right *= c.flip;  // As the texels' normals have it.
  texel = c.texel;
}
)";
}

std::string impostor_fragment() {
  return std::string(kHead) + kLight + kPattern + kClothes + kFigure + R"(
in vec3 texel;
void main() {
  float rank = threshold();
  if (rank < shown_from || rank > shown_to) discard;
  if (texture(albedo, texel).a < 0.5) discard;  // Filtered: a smooth outline.
  show(texel, right);
}
)";
}

// Four views at once: a card that holds all their rectangles. Each pixel shows one of them, by its
// place in the pattern.
std::string blended_vertex() {
  return std::string(kHead) + kSunlit + kFade + kOutfit + kCard + R"(
uniform usampler2D instances;
uniform usampler2D views;
uniform int first;
uniform float side;    // Of a view [m].
uniform float pixels;  // Along a view's side.
out vec2 card_texel;  // On the card, in texels of a view, from its upper left corner.
flat out vec3 limits;  // Of the pattern: where the second, third and fourth view begin.
// From card_texel to a place in the page: x times the first plus the second, y plus the third; the
// fourth is the page.
flat out vec4 map0, map1, map2, map3;
flat out vec4 box0, box1, box2, box3;  // The rectangle in its page.
vec2 low, high;
void add(uint word, out vec4 map, out vec4 box) {
  int view = int(word & 0xfffffu) * 2;
  vec4 place = vec4(texelFetch(views, ivec2(view & 1023, view >> 10), 0));
  vec4 part = vec4(texelFetch(views, ivec2((view & 1023) + 1, view >> 10), 0));
  bool mirrored = (word >> 20 & 1u) == 1u;
  box = vec4(place.xy, place.xy + place.zw);
  map = mirrored ? vec4(-1.0, place.x + pixels - part.x, place.y - part.y, part.z)
                 : vec4(1.0, place.x - part.x, place.y - part.y, part.z);
  vec2 corner = vec2(mirrored ? pixels - part.x - place.z : part.x, part.y);
  low = min(low, corner);
  high = max(high, corner + place.zw);
}
void main() {
  int at = (gl_VertexID >> 2) * 2 + first, k = gl_VertexID & 3;
  uvec4 data = texelFetch(instances, ivec2(at & 2047, at >> 11), 0);
  uvec4 more = texelFetch(instances, ivec2((at & 2047) + 1, at >> 11), 0);
  low = vec2(pixels);
  high = vec2(0.0);
  add(data.w, map0, box0);
  add(more.x, map1, box1);
  add(more.y, map2, box2);
  add(more.z, map3, box3);
  vec2 next = vec2(more.w & 511u, more.w >> 9u) / 256.0;
  limits.x = (1.0 - next.x) * (1.0 - next.y);
  limits.y = 1.0 - next.y;
  limits.z = limits.y + (1.0 - next.x) * next.y;
  card_texel = mix(low, high, vec2(float(k & 1), float(k >> 1)));
  stand(uintBitsToFloat(data.xyz), (card_texel - 0.5 * pixels) * vec2(1.0, -1.0) * (side / pixels),
        data.w >> 21);
}
)";
}

std::string blended_fragment() {
  return std::string(kHead) + kLight + kPattern + kClothes + kFigure + R"(
in vec2 card_texel;
flat in vec3 limits;
flat in vec4 map0, map1, map2, map3;
flat in vec4 box0, box1, box2, box3;
void main() {
  vec2 page = vec2(textureSize(albedo, 0).xy);
  vec2 a_right = dFdx(card_texel) / page, a_down = dFdy(card_texel) / page;
  float rank = threshold();
  if (rank < shown_from || rank > shown_to) discard;
  // The pixels that this level of detail shows are divided among the views.
  float share = (rank - shown_from) / max(shown_to - shown_from, 1e-3);
  vec4 map = share < limits.y ? share < limits.x ? map0 : map1 : share < limits.z ? map2 : map3;
  vec4 box = share < limits.y ? share < limits.x ? box0 : box1 : share < limits.z ? box2 : box3;
  vec2 at = vec2(map.x * card_texel.x + map.y, card_texel.y + map.z);
  if (any(lessThan(at, box.xy)) || any(greaterThan(at, box.zw))) discard;
  vec3 texel = vec3(at / page, map.w);
  if (textureGrad(albedo, texel, a_right, a_down).a < 0.5) discard;
  show(texel, right * map.x);
}
)";
}

// A mesh between two of its poses, turned and put where its avatar is.
std::string model_vertex(Leaning leaning) {
  return std::string(kHead) + lean_of(leaning) + kSunlit + kFade + kOutfit + R"(
layout(location = 0) in uvec4 paint;  // Albedo and part.
uniform usampler2D instances;
uniform usampler2D poses;
uniform int first, vertices, first_frame, frames;
uniform vec3 low, extent;
uniform float centre;
out vec3 world;
out vec3 normal;
out float height;
flat out vec3 albedo_root;
flat out uint part;
flat out uint outfit;
flat out float in_sun;
flat out float shown_to;
uvec4 posed(int frame) {
  int at = (first_frame + frame) * vertices + gl_VertexID;
  return texelFetch(poses, ivec2(at & 2047, at >> 11), 0);
}
vec3 unfolded(uint bytes) {
  vec2 f = (vec2(bytes & 255u, bytes >> 8u) - 128.0) / 127.0;
  float up = 1.0 - abs(f.x) - abs(f.y);
  vec2 side = f;
  if (up < 0.0) side = (1.0 - abs(f.yx)) * vec2(f.x < 0.0 ? -1.0 : 1.0, f.y < 0.0 ? -1.0 : 1.0);
  return vec3(side.x, up, side.y);
}
void main() {
#ifdef LEANS
  int number = first + gl_InstanceID * 2;
  axis = uintBitsToFloat(texelFetch(instances, ivec2((number & 2047) + 1, number >> 11), 0).xyz);
#else
  int number = first + gl_InstanceID;
#endif
  uvec4 data = texelFetch(instances, ivec2(number & 2047, number >> 11), 0);
  float cycle = float(data.w >> 11u & 1023u) / 1024.0 * float(frames);
  int frame = int(cycle) % frames;
  uvec4 a = posed(frame), b = posed((frame + 1) % frames);
  float share = fract(cycle);
  vec3 p = low + extent * mix(vec3(a.xyz), vec3(b.xyz), share) / 65535.0;
  vec3 n = mix(unfolded(a.w), unfolded(b.w), share);
  float heading = float(data.w & 2047u) * (6.283185307 / 2048.0);
  float s = sin(heading), c = cos(heading);
  vec3 feet = uintBitsToFloat(data.xyz);
  height = p.y;
#ifdef LEANS
  world = feet + leaned(vec3(p.x * c + p.z * s, p.y, p.z * c - p.x * s));
  normal = leaned(vec3(n.x * c + n.z * s, n.y, n.z * c - n.x * s));
  vec3 middle = feet + axis * centre;
#else
  world = feet + vec3(p.x * c + p.z * s, p.y, p.z * c - p.x * s);
  normal = vec3(n.x * c + n.z * s, n.y, n.z * c - n.x * s);
  vec3 middle = feet + vec3(0.0, centre, 0.0);
#endif
  albedo_root = vec3(paint.rgb) / 255.0;
  part = paint.a;
  outfit = outfit_of(data.w >> 21);
  in_sun = sunlit_once(middle + to_sun * 0.9);
  shown_to = 1.0 - share_beyond(mesh_range, length(eye - middle));
  gl_Position = clip_from_world * vec4(world, 1.0);
}
)";
}

std::string model_fragment() {
  return std::string(kHead) + kLight + kPattern + kClothes + R"(
in vec3 world;
in vec3 normal;
in float height;
flat in vec3 albedo_root;
flat in uint part;
flat in uint outfit;
flat in float in_sun;
flat in float shown_to;
out vec4 colour;
void main() {
  if (threshold() > shown_to) discard;
  vec3 n = normalize(normal);
  if (dot(n, eye - world) < 0.0) n = -n;  // Thin clothes have an inside.
  float shade = mix(0.72, 1.0, smoothstep(0.0, 0.7, height));
  vec3 own = dressed(albedo_root * albedo_root, part, outfit);
  colour = shown(lit(own, n, in_sun) * shade, world - eye);
}
)";
}

// A figure of a few pixels: head, shirt and trousers, lit where it stands. One vertex instead of
// six and no texture but that of its three colours, by its look.
std::string point_vertex() {
  return std::string(kHead) + kLight + kSunlit + kFade + R"(
uniform usampler2D instances;
uniform usampler2D looks;     // Head, chest and legs, 8 bits a channel, as square roots.
uniform int first;
uniform float centre;         // Half a figure's height [m].
uniform float pixels_at_one;  // Of a metre at a metre's distance.
flat out vec3 head, chest, legs;
flat out vec3 shape;  // Half its width, and where the chest and the legs begin, of its height.
flat out float shown_from;
vec3 albedo_of(uint bytes) {
  vec3 root = vec3(bytes & 255u, bytes >> 8u & 255u, bytes >> 16u) / 255.0;
  return root * root;
}
void main() {
  int number = gl_VertexID + first;
  uvec4 data = texelFetch(instances, ivec2(number & 2047, number >> 11), 0);
  uvec4 colours = texelFetch(looks, ivec2(int(data.w >> 21), 0), 0);
  vec3 middle = uintBitsToFloat(data.xyz) + vec3(0.0, centre, 0.0);
  vec3 from_eye = middle - eye;
  float far = length(from_eye);
  float flat_share = length(from_eye.xz) / far;
  gl_Position = clip_from_world * vec4(middle, 1.0);
  // As seen from above, a figure is shorter and its head larger.
  float high = 2.0 * centre * flat_share + 0.3 * (1.0 - flat_share);
  float size = max(high * pixels_at_one / gl_Position.w, 1.0);
  gl_PointSize = size;
  shape = vec3(max(0.21 / high, 0.55 / size), mix(0.45, 0.16, flat_share),
               mix(0.9, 0.54, flat_share));
  // The mean of the sunlight on the visible sides.
  vec3 normal = normalize(from_eye / -far + vec3(0.0, 0.3, 0.0));
  vec3 light = lit(vec3(1.0), normal, sunlit_once(middle + to_sun * 0.9));
  float haze_share = 1.0 - exp(-haze * far);
  vec3 air = sky_colour(vec3(0.0)) * haze_share;
  light *= 1.0 - haze_share;
  head = sqrt(min(albedo_of(colours.x) * light + air, 1.0));
  chest = sqrt(min(albedo_of(colours.y) * light + air, 1.0));
  legs = sqrt(min(albedo_of(colours.z) * light * 0.85 + air, 1.0));
  shown_from = 1.0 - share_beyond(point_range, far);
}
)";
}

std::string point_fragment() {
  return std::string(kHead) + kPattern + R"(
flat in vec3 head, chest, legs;
flat in vec3 shape;
flat in float shown_from;
out vec4 colour;
void main() {
  float down = gl_PointCoord.y;
  float wide = down < shape.y ? 0.55 : down < shape.z ? 1.0 : 0.72;
  if (abs(gl_PointCoord.x - 0.5) > shape.x * wide || threshold() < shown_from) discard;
  colour = vec4(down < shape.y ? head : down < shape.z ? chest : legs, 1.0);
}
)";
}

// A rectangle of one colour: the minimal cost of drawing so many instances.
std::string plain_vertex() {
  return std::string(kHead) + R"(
uniform usampler2D instances;
uniform int first;
uniform float centre;
flat out vec3 tint;
void main() {
  int number = (gl_VertexID >> 2) + first, k = gl_VertexID & 3;
  uvec4 data = texelFetch(instances, ivec2(number & 2047, number >> 11), 0);
  vec3 middle = uintBitsToFloat(data.xyz) + vec3(0.0, centre, 0.0);
  vec3 towards = normalize(eye - middle);
  float flat_length = length(towards.xz);
  vec3 right = vec3(towards.z, 0.0, -towards.x) / max(flat_length, 1e-4);
  vec3 up = cross(towards, right);
  vec2 at = (vec2(float(k & 1), float(k >> 1)) - 0.5) * vec2(0.6, 2.0 * centre);
  uint look = data.w >> 21;
  tint = vec3(look & 7u, look >> 3u & 7u, look >> 6u & 7u) / 7.0;
  gl_Position = clip_from_world * vec4(middle + right * at.x + up * at.y, 1.0);
}
)";
}

std::string plain_fragment() {
  return std::string(kHead) + R"(
flat in vec3 tint;
out vec4 colour;
void main() { colour = vec4(tint, 1.0); }
)";
}

// The card that the sun sees, in the shadow map.
std::string shadow_vertex(Leaning leaning) {
  return std::string(kHead) + lean_of(leaning) + kPull + R"(
uniform vec3 sun_right, sun_up;
uniform float centre;  // Over the feet [m].
out vec3 texel;
void main() {
  Corner c = pull();
#ifdef LEANS
  vec3 middle = c.feet + axis * centre, card_right = right_of(to_sun);
  vec3 card_up = cross(to_sun, card_right);
#else
  vec3 middle = c.feet + vec3(0.0, centre, 0.0), card_right = sun_right, card_up = sun_up;
#endif
  texel = c.texel;
  gl_Position = clip_from_world *
                vec4(middle + card_right * c.offset.x + card_up * c.offset.y, 1.0);
}
)";
}

std::string shadow_fragment() {
  return std::string(kHead) + R"(
in vec3 texel;
uniform sampler2DArray albedo;
void main() {
  if (texture(albedo, texel).a < 0.5) discard;
}
)";
}

}  // namespace throng::draw::shaders
