#include "tests/bench/bench_mesh.h"

#include "renderer/io/import_mesh.h"
#include "renderer/math/bounds.h"

#include <fstream>
#include <iterator>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>
#include <variant>

namespace bench {

using namespace renderer;

Mesh read_mesh(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    if (!file) throw std::runtime_error("cannot read " + path);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    const auto nothing_else = [](std::string_view) { return std::optional<std::span<const std::byte>>(); };
    ImportResult result = import_mesh(path, std::as_bytes(std::span(bytes)), nothing_else, Limits::none());
    if (const ImportFault* fault = std::get_if<ImportFault>(&result))
        throw std::runtime_error(path + ": " + fault->detail);
    return std::move(std::get<ImportedMesh>(result).mesh);
}

double diagonal_of(const Mesh& mesh)
{
    Bounds3f bounds;
    for (const Vec3f& position : mesh.positions)
        bounds.extend(position);
    return length(to_double(bounds.extent()));
}

void scale_mesh(Mesh& mesh, double factor)
{
    for (Vec3f& position : mesh.positions)
        position = to_float(to_double(position) * factor);
}

} // namespace bench
