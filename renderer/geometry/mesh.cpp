#include "renderer/geometry/mesh.h"

namespace renderer {

Bounds3f Mesh::bounds() const
{
    Bounds3f box;
    for (const Triangle& triangle : triangles)
        for (const std::uint32_t vertex : triangle)
            box.extend(positions[vertex]);
    return box;
}

Bounds3d Mesh::bounds_in_file() const
{
    Bounds3d box;
    for (const Triangle& triangle : triangles)
        for (const std::uint32_t vertex : triangle)
            box.extend(position(vertex));
    return box.empty() ? box : Bounds3d{box.lower + origin, box.upper + origin};
}

std::uint64_t Mesh::size_bytes() const
{
    const auto bytes = [](const auto& array) {
        return static_cast<std::uint64_t>(array.capacity()) * sizeof(*array.data());
    };
    std::uint64_t sum = bytes(positions) + bytes(residuals) + bytes(normals) + bytes(uvs) + bytes(triangles) +
                        bytes(triangle_materials) + bytes(materials) + bytes(parts);
    for (const MeshMaterial& material : materials) {
        sum += material.name.capacity() + bytes(material.textures);
        for (const std::string& texture : material.textures)
            sum += texture.capacity();
    }
    for (const MeshPart& part : parts)
        sum += part.name.capacity();
    for (const MeshImage& named : images)
        sum += sizeof named + named.name.capacity() + bytes(named.image.bytes);
    return sum;
}

std::map<std::string_view, const MeshPart*> Mesh::parts_by_name() const
{
    std::map<std::string_view, const MeshPart*> named;
    for (const MeshPart& part : parts)
        named.emplace(part.name, &part);
    return named;
}

} // namespace renderer
