#include "renderer/io/flatten_scene.h"

#include "renderer/geometry/mesh_frame.h"
#include "renderer/io/import_bounds.h"
#include "renderer/io/scene_frame.h"
#include "renderer/io/scene_material.h"
#include "renderer/io/text.h"
#include "renderer/io/triangulate.h"
#include "renderer/math/affine.h"

#include <assimp/material.h>
#include <assimp/scene.h>

#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace renderer {

namespace {

Vec3f vec3(const aiVector3D& v)
{
    return {v.x, v.y, v.z};
}

Affine3 affine(const aiMatrix4x4& m)
{
    Affine3 out;
    out.rows = {Vec3d{m.a1, m.a2, m.a3}, Vec3d{m.b1, m.b2, m.b3}, Vec3d{m.c1, m.c2, m.c3}};
    out.translation = {m.a4, m.b4, m.c4};
    return out;
}

// One of assimp's meshes, made ready once, placed as often as nodes name it.
struct Piece {
    std::vector<Vec3f> positions, normals;
    std::vector<Vec2f> uvs;
    std::vector<Triangle> triangles;
    std::uint64_t lines_and_points = 0;
};

class Flattener {
public:
    Flattener(const aiScene& scene, CompanionFiles& files, const Limits& limits, ImportedMesh& result)
        : scene_(scene), images_(files, limits, result), limits_(limits), result_(result),
          pieces_(scene.mNumMeshes)
    {
    }
    std::optional<ImportFault> run();

private:
    std::optional<ImportFault> make_piece(unsigned number);
    void make_flat(Piece& piece) const;
    bool is_gltf() const { return result_.format == "gltf" || result_.format == "glb"; }
    bool is_assimps_own(unsigned material) const;
    void materials();
    void count(const aiNode& node);
    void place(const aiNode& node, const Affine3& world_from_parent);
    void place(const Piece& piece, const Affine3& world_from_object, unsigned material);

    const aiScene& scene_;
    MeshImages images_;
    const Limits& limits_;
    ImportedMesh& result_;
    std::vector<Piece> pieces_;
    Array<Vec3d> in_file_; // positions, placed
    bool with_normals_ = false, with_uvs_ = false, with_materials_ = false;
    std::uint64_t triangles_ = 0, lines_and_points_ = 0;
};

std::optional<ImportFault> Flattener::make_piece(unsigned number)
{
    const aiMesh& mesh = *scene_.mMeshes[number];
    Piece& piece = pieces_[number];
    constexpr std::uint32_t kUnused = 0xffffffff;
    std::vector<std::uint32_t> made(mesh.mNumVertices, kUnused);
    std::vector<std::uint32_t> corners;
    std::vector<Vec3d> outline;
    std::vector<Triangle> pieces;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
        const aiFace& face = mesh.mFaces[f];
        if (face.mNumIndices < 3) {
            ++piece.lines_and_points;
            continue;
        }
        corners.clear();
        for (unsigned i = 0; i < face.mNumIndices; ++i) {
            const unsigned from = face.mIndices[i];
            if (from >= mesh.mNumVertices)
                return ImportFault{"index_out_of_range",
                                   "mesh " + in_quotes(mesh.mName.C_Str()) + ", face " + std::to_string(f) +
                                       ": vertex " + std::to_string(from) + "; it has " +
                                       std::to_string(mesh.mNumVertices)};
            if (made[from] == kUnused) {
                made[from] = static_cast<std::uint32_t>(piece.positions.size());
                piece.positions.push_back(vec3(mesh.mVertices[from]));
                if (mesh.mNormals) piece.normals.push_back(vec3(mesh.mNormals[from]));
                if (with_uvs_) {
                    const aiVector3D uv =
                        mesh.mTextureCoords[0] ? mesh.mTextureCoords[0][from] : aiVector3D();
                    piece.uvs.push_back({uv.x, uv.y});
                }
            }
            corners.push_back(made[from]);
        }
        if (corners.size() == 3) {
            piece.triangles.push_back({corners[0], corners[1], corners[2]});
            continue;
        }
        outline.clear();
        pieces.clear();
        for (const std::uint32_t corner : corners)
            outline.push_back(to_double(piece.positions[corner]));
        if (!triangulate(outline, pieces))
            return ImportFault{"over_limit",
                               "mesh " + in_quotes(mesh.mName.C_Str()) + ", face " + std::to_string(f) +
                                   ": a concave polygon of " + std::to_string(corners.size()) +
                                   " corners, the limit is " + std::to_string(kMostConcaveCorners) +
                                   ": export triangles"};
        for (const Triangle& t : pieces)
            piece.triangles.push_back({corners[t[0]], corners[t[1]], corners[t[2]]});
    }
    if (with_normals_ && !mesh.mNormals) make_flat(piece);
    return std::nullopt;
}

// Triangles that share nothing and carry their own normals: for a mesh without normals beside one that has
// them.
void Flattener::make_flat(Piece& piece) const
{
    Piece flat;
    for (const Triangle& t : piece.triangles) {
        const std::array corners{piece.positions[t[0]], piece.positions[t[1]], piece.positions[t[2]]};
        const std::array outline{to_double(corners[0]), to_double(corners[1]), to_double(corners[2])};
        const auto first = static_cast<std::uint32_t>(flat.positions.size());
        flat.triangles.push_back({first, first + 1, first + 2});
        flat.positions.insert(flat.positions.end(), corners.begin(), corners.end());
        flat.normals.insert(flat.normals.end(), 3, polygon_normal(outline));
        if (with_uvs_) flat.uvs.insert(flat.uvs.end(), {piece.uvs[t[0]], piece.uvs[t[1]], piece.uvs[t[2]]});
    }
    flat.lines_and_points = piece.lines_and_points;
    piece = std::move(flat);
}

// For glTF it appends one; for other formats it gives one to meshes that have none, under names of its own.
bool Flattener::is_assimps_own(unsigned material) const
{
    if (is_gltf()) return material + 1 == scene_.mNumMaterials;
    const aiString name = const_cast<aiMaterial&>(*scene_.mMaterials[material]).GetName();
    const std::string_view said = name.C_Str();
    return said == AI_DEFAULT_MATERIAL_NAME || said == "%%%DEFAULT" || said.empty();
}

void Flattener::materials()
{
    // Where the file has none but assimp's own, the mesh has none.
    for (unsigned i = 0; i < scene_.mNumMaterials; ++i)
        with_materials_ = with_materials_ || !is_assimps_own(i);
    for (unsigned i = 0; with_materials_ && i < scene_.mNumMaterials; ++i) {
        const aiMaterial& from = *scene_.mMaterials[i];
        MeshMaterial& to = result_.mesh.materials.emplace_back();
        to.name = clean_utf8(const_cast<aiMaterial&>(from).GetName().C_Str());
        if (is_assimps_own(i) && !is_gltf()) continue; // grey, as any without a colour
        read_scene_material(from, scene_, is_assimps_own(i), images_, to);
    }
}

void Flattener::count(const aiNode& node)
{
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
        triangles_ += pieces_[node.mMeshes[i]].triangles.size();
        lines_and_points_ += pieces_[node.mMeshes[i]].lines_and_points;
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i)
        count(*node.mChildren[i]);
}

void Flattener::place(const Piece& piece, const Affine3& world_from_object, unsigned material)
{
    Mesh& mesh = result_.mesh;
    const auto first = static_cast<std::uint32_t>(in_file_.size());
    const auto& rows = world_from_object.rows;
    // Normals go with the cofactors, which exist where the inverse does not; a mirroring transform turns both
    // them and the winding.
    const double side = world_from_object.determinant() < 0 ? -1 : 1;
    const std::array<Vec3d, 3> cofactors{
        cross(rows[1], rows[2]) * side, cross(rows[2], rows[0]) * side, cross(rows[0], rows[1]) * side};
    for (const Vec3f p : piece.positions)
        in_file_.push_back(world_from_object.point(to_double(p)));
    for (const Vec3f given : piece.normals) {
        const Vec3d n = to_double(given);
        const Vec3d turned{dot(cofactors[0], n), dot(cofactors[1], n), dot(cofactors[2], n)};
        mesh.normals.push_back(max_component(abs(turned)) > 0 ? to_float(normalize(turned)) : Vec3f{0, 0, 1});
    }
    mesh.uvs.append(piece.uvs);
    for (Triangle t : piece.triangles) {
        if (side < 0) std::swap(t[1], t[2]);
        mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
    if (with_materials_)
        mesh.triangle_materials.append(piece.triangles.size(), static_cast<std::uint16_t>(material));
}

void Flattener::place(const aiNode& node, const Affine3& world_from_parent)
{
    const Affine3 world_from_node = world_from_parent * affine(node.mTransformation);
    const auto first = static_cast<std::uint32_t>(result_.mesh.triangles.size());
    const std::size_t part = result_.mesh.parts.size();
    result_.mesh.parts.push_back({clean_utf8(node.mName.C_Str()), first, 0});
    for (unsigned i = 0; i < node.mNumMeshes; ++i)
        place(pieces_[node.mMeshes[i]], world_from_node, scene_.mMeshes[node.mMeshes[i]]->mMaterialIndex);
    for (unsigned i = 0; i < node.mNumChildren; ++i)
        place(*node.mChildren[i], world_from_node);
    result_.mesh.parts[part].triangle_count =
        static_cast<std::uint32_t>(result_.mesh.triangles.size()) - first;
}

std::optional<ImportFault> Flattener::run()
{
    if (scene_.mNumMaterials > kMostMaterials)
        return ImportFault{"over_limit",
                           std::to_string(scene_.mNumMaterials) + " materials, the limit is " +
                               std::to_string(kMostMaterials)};
    for (unsigned i = 0; i < scene_.mNumMeshes; ++i) {
        with_normals_ = with_normals_ || scene_.mMeshes[i]->mNormals != nullptr;
        with_uvs_ = with_uvs_ || scene_.mMeshes[i]->mTextureCoords[0] != nullptr;
    }
    for (unsigned i = 0; i < scene_.mNumMeshes; ++i)
        if (auto bad = make_piece(i)) return bad;
    count(*scene_.mRootNode);
    if (triangles_ > limits_.triangles) return over_triangle_limit(triangles_, limits_, false);
    materials();
    place(*scene_.mRootNode, world_from_file(scene_));
    set_positions(result_.mesh, in_file_);
    std::erase_if(result_.mesh.parts,
                  [](const MeshPart& p) { return p.name.empty() || p.triangle_count == 0; });
    if (lines_and_points_)
        result_.notes.push_back(std::to_string(lines_and_points_) +
                                " lines and points were left out: only triangles render");
    if (scene_.mNumAnimations)
        result_.notes.push_back("animations were left out: the file's rest pose is used");
    return std::nullopt;
}

} // namespace

std::optional<ImportFault>
flatten_scene(const aiScene& scene, CompanionFiles& files, const Limits& limits, ImportedMesh& result)
{
    return Flattener(scene, files, limits, result).run();
}

} // namespace renderer
