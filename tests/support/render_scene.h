// render_description: from a description to a film by the renderer's front door, for tests; and meshes to put
// in.
#pragma once

#include "renderer/description/scene_description.h"
#include "renderer/description/settings.h"
#include "renderer/geometry/mesh.h"
#include "renderer/render.h"

#include <cstdint>
#include <string>
#include <vector>

namespace tests {

struct TestScene {
    renderer::SceneDescription description;
    std::vector<renderer::Mesh> meshes; // description.meshes is filled to match
    renderer::RenderSettings settings;
    std::vector<renderer::SharedImage> images{}; // which materials name by their number
};

// A scene, made ready: throws std::runtime_error with the first fault's text if the plan refuses it.
struct ReadyScene {
    renderer::Plan plan;
    std::shared_ptr<const renderer::Scene> scene;
};
ReadyScene
make_ready(const TestScene& test, renderer::ThreadPool& pool, renderer::SceneCaches* caches = nullptr);

renderer::RenderResult
render_description(const TestScene& test, unsigned threads = 2, renderer::SceneCaches* caches = nullptr);

// A (2,3) torus knot, smooth, with normals: rings x sides quads.
renderer::Mesh knot(std::uint32_t rings = 96, std::uint32_t sides = 12);
// A unit sphere of triangles with vertex normals.
renderer::Mesh faceted_sphere(std::uint32_t segments, std::uint32_t rings);

// Everything that is modelled, in one small picture.
TestScene kitchen_sink();

// FNV-1a of the film's sums, bit for bit.
std::uint64_t digest(const renderer::Film& film);
std::string hex(std::uint64_t value);

} // namespace tests
