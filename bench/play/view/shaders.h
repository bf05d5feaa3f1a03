// SPDX-License-Identifier: MIT
#pragma once

namespace cairn::play {

// A vertex is scaled, then placed by three rows of a matrix: one mesh for boxes of all sizes.
inline constexpr const char* kBodyVertex = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 row0;
layout(location = 3) in vec4 row1;
layout(location = 4) in vec4 row2;
layout(location = 5) in vec4 scale;
layout(location = 6) in vec4 colour;  // a: see Surface in renderer.h
uniform mat4 camera, light;
out vec3 at_world, at_body, normal_world;
out vec4 at_light;
flat out vec3 half_size;
flat out vec4 paint;
void main() {
  at_body = position * scale.xyz;
  vec3 n = normalize((colour.a == 2.0 ? position : normal) / scale.xyz);  // balls are round
  vec4 p = vec4(at_body, 1);
  at_world = vec3(dot(row0, p), dot(row1, p), dot(row2, p));
  normal_world = vec3(dot(row0.xyz, n), dot(row1.xyz, n), dot(row2.xyz, n));
  half_size = scale.xyz;
  paint = colour;
  at_light = light * vec4(at_world, 1);
  gl_Position = camera * vec4(at_world, 1);
}
)";

inline constexpr const char* kBodyFragment = R"(#version 330 core
in vec3 at_world, at_body, normal_world;
in vec4 at_light;
flat in vec3 half_size;
flat in vec4 paint;
uniform vec3 eye, sun, horizon;
uniform float haze;  // 1 / distance
uniform int shadows;
uniform sampler2DShadow shadow;
out vec4 result;

float Lit(float slope) {
  if (shadows == 0) return 1.0;
  vec3 p = at_light.xyz * 0.5 + 0.5;
  if (any(greaterThan(abs(p - 0.5), vec3(0.5)))) return 1.0;
  float texel = 1.0 / 2048.0, sum = 0.0;
  p.z -= 0.0006 + 0.0012 * slope;
  for (int i = 0; i < 4; ++i) {
    vec2 offset = (vec2(i & 1, i >> 1) - 0.5) * 1.5 * texel;
    sum += texture(shadow, vec3(p.xy + offset, p.z));
  }
  return sum * 0.25;
}

float GridLine(vec2 at, float cell, float width) {
  vec2 d = abs(fract(at / cell - 0.5) - 0.5) * cell;
  vec2 w = fwidth(at) + width;
  vec2 line = (1.0 - smoothstep(w * 0.4, w * 1.2, d)) * min(vec2(1.0), cell * 0.15 / w);
  return max(line.x, line.y);
}

void main() {
  vec3 n = normalize(normal_world), to_eye = eye - at_world;
  float away = length(to_eye);
  vec3 v = to_eye / away;
  vec3 base = paint.rgb;
  if (paint.a == 1.0) {  // box: darker along its edges
    vec3 d = half_size - abs(at_body);
    float nearest = min(d.x, min(d.y, d.z)), farthest = max(d.x, max(d.y, d.z));
    float middle = d.x + d.y + d.z - nearest - farthest;
    float rim = 0.03 * min(half_size.x, min(half_size.y, half_size.z)) + 0.0011 * away;
    base *= mix(0.52, 1.0, smoothstep(0.2 * rim, 1.3 * rim, middle));
  } else if (paint.a == 2.0) {  // ball: two tones, so that it is seen to roll
    base *= at_body.x * at_body.y * at_body.z > 0.0 ? 1.0 : 0.72;
  } else if (paint.a == 3.0 && n.y > 0.9) {  // ground
    float line = max(0.45 * GridLine(at_world.xz, 1.0, 0.012), GridLine(at_world.xz, 5.0, 0.03));
    base = mix(base, base * 0.72, line);
  }
  float slope = 1.0 - max(dot(n, sun), 0.0);
  float direct = max(dot(n, sun), 0.0);
  if (direct > 0.0) direct *= Lit(slope);
  vec3 sky = mix(vec3(0.30, 0.27, 0.25), vec3(0.50, 0.58, 0.70), n.y * 0.5 + 0.5);
  float gloss = pow(max(dot(n, normalize(sun + v)), 0.0), 40.0) * 0.10 * step(0.001, direct);
  vec3 light = sky * 0.78 + vec3(1.0, 0.94, 0.83) * direct * 0.95;
  vec3 seen = base * light + gloss;
  float far = 1.0 - exp(-pow(away * haze, 2.0));
  seen = mix(seen, horizon, far);
  result = vec4(pow(seen, vec3(1.0 / 2.2)), 1.0);
}
)";

inline constexpr const char* kDepthFragment = "#version 330 core\nvoid main() {}\n";

/// A sky over the whole target, without a buffer.
inline constexpr const char* kSkyVertex = R"(#version 330 core
uniform mat4 from_camera;
out vec3 along;
void main() {
  vec2 p = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  vec4 near = from_camera * vec4(p, -1, 1), far = from_camera * vec4(p, 1, 1);
  along = far.xyz / far.w - near.xyz / near.w;
  gl_Position = vec4(p, 0.99999, 1);
}
)";
inline constexpr const char* kSkyFragment = R"(#version 330 core
in vec3 along;
uniform vec3 horizon, zenith;
out vec4 result;
void main() {
  float up = clamp(normalize(along).y, 0.0, 1.0);
  result = vec4(pow(mix(horizon, zenith, sqrt(up)), vec3(1.0 / 2.2)), 1.0);
}
)";

/// Lines and dots in one colour a vertex.
inline constexpr const char* kLineVertex = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 colour;
uniform mat4 camera;
out vec3 paint;
void main() {
  paint = colour;
  gl_Position = camera * vec4(position, 1);
  gl_PointSize = 4.0;
}
)";
inline constexpr const char* kLineFragment =
    "#version 330 core\nin vec3 paint;\nout vec4 result;\nvoid main() { result = vec4(paint, 1); }";

}  // namespace cairn::play
