#include "tests/assets/write_files.h"
#include "tests/assets/write_scenes.h"

#include <string_view>

namespace tests {
namespace {

// A record's properties on their way; the type comes before each.
class Properties {
public:
    Properties& text(std::string_view value)
    {
        add('S');
        append(bytes, static_cast<std::uint32_t>(value.size()));
        bytes += value;
        return *this;
    }
    Properties& whole(std::int32_t value)
    {
        add('I');
        append(bytes, value);
        return *this;
    }
    Properties& identifier(std::int64_t value)
    {
        add('L');
        append(bytes, value);
        return *this;
    }
    Properties& real(double value)
    {
        add('D');
        append(bytes, value);
        return *this;
    }
    template <typename T>
    Properties& array(char type, const std::vector<T>& values)
    {
        add(type);
        append(bytes, static_cast<std::uint32_t>(values.size()));
        append(bytes, std::uint32_t{0}); // not compressed
        append(bytes, static_cast<std::uint32_t>(values.size() * sizeof(T)));
        for (const T value : values)
            append(bytes, value);
        return *this;
    }
    std::uint32_t count = 0;
    std::string bytes;

private:
    void add(char type)
    {
        ++count;
        bytes += type;
    }
};

struct Record {
    std::string name;
    Properties properties;
    std::vector<Record> inside;
};

constexpr std::size_t kRecordHead = 13;

// Ends are counted from the file's beginning.
void write_record(std::string& out, const Record& record)
{
    const std::size_t begin = out.size();
    append(out, std::uint32_t{0});
    append(out, record.properties.count);
    append(out, static_cast<std::uint32_t>(record.properties.bytes.size()));
    out += static_cast<char>(record.name.size());
    out += record.name + record.properties.bytes;
    for (const Record& inner : record.inside)
        write_record(out, inner);
    if (!record.inside.empty()) out.append(kRecordHead, '\0');
    std::string end;
    append(end, static_cast<std::uint32_t>(out.size()));
    out.replace(begin, 4, end);
}

std::vector<double> coordinates(const AssetMesh& mesh)
{
    std::vector<double> out;
    for (const auto& p : mesh.positions)
        out.insert(out.end(), p.begin(), p.end());
    return out;
}

// The last corner of a face is written as its complement.
std::vector<std::int32_t> corners(const AssetMesh& mesh)
{
    std::vector<std::int32_t> out;
    for (const auto& t : mesh.triangles)
        out.insert(out.end(),
                   {static_cast<std::int32_t>(t[0]),
                    static_cast<std::int32_t>(t[1]),
                    ~static_cast<std::int32_t>(t[2])});
    return out;
}

std::vector<std::array<std::int64_t, 2>> connections(const FbxWords& words)
{
    std::vector<std::array<std::int64_t, 2>> all{{1, 2}, {2, 0}};
    all.insert(all.end(), words.connections.begin(), words.connections.end());
    return all;
}

Record setting(const char* name, const char* type, const char* label, double value)
{
    Properties p;
    p.text(name).text(type).text(label).text("");
    if (std::string_view(type) == "int")
        p.whole(static_cast<std::int32_t>(value));
    else
        p.real(value);
    return {"P", p, {}};
}

std::string joined(const auto& numbers)
{
    std::string out;
    for (const auto value : numbers)
        (out += out.empty() ? "" : ",") += decimal(static_cast<float>(value));
    return out;
}

} // namespace

std::string fbx_bytes(const AssetMesh& mesh, const FbxWords& words)
{
    const std::string separator("\0\x01", 2); // between a name and its class
    std::string out("Kaydara FBX Binary  \0\x1a\0", 23);
    append(out, std::uint32_t{7400});
    const auto model = [&](std::int64_t id, const std::string& name, const char* kind) {
        return Record{"Model",
                      Properties().identifier(id).text(name + separator + "Model").text(kind),
                      {{"Version", Properties().whole(232), {}}}};
    };
    Record connected{"Connections", {}, {}};
    for (const auto& [child, parent] : connections(words))
        connected.inside.push_back({"C", Properties().text("OO").identifier(child).identifier(parent), {}});
    const std::vector<Record> records{
        {"FBXHeaderExtension",
         {},
         {{"FBXHeaderVersion", Properties().whole(1003), {}}, {"FBXVersion", Properties().whole(7400), {}}}},
        {"GlobalSettings",
         {},
         {{"Version", Properties().whole(1000), {}},
          {"Properties70",
           {},
           {setting("UpAxis", "int", "Integer", words.up_axis),
            setting("UpAxisSign", "int", "Integer", 1),
            setting("UnitScaleFactor", "double", "Number", words.unit_cm)}}}},
        {"Objects",
         {},
         {{"Geometry",
           Properties().identifier(1).text("ball" + separator + "Geometry").text("Mesh"),
           {{"Vertices", Properties().array('d', coordinates(mesh)), {}},
            {"PolygonVertexIndex", Properties().array('i', corners(mesh)), {}}}},
          model(2, "ball", "Mesh"),
          model(3, "first", "Null"),
          model(4, "second", "Null")}},
        connected};
    for (const Record& record : records)
        write_record(out, record);
    return out.append(kRecordHead, '\0');
}

std::string fbx_text(const AssetMesh& mesh, const FbxWords& words)
{
    const std::vector<double> vertices = coordinates(mesh);
    const std::vector<std::int32_t> indices = corners(mesh);
    std::string index_list;
    for (const std::int32_t index : indices)
        (index_list += index_list.empty() ? "" : ",") += std::to_string(index);
    std::string connected;
    for (const auto& [child, parent] : connections(words))
        connected += "\tC: \"OO\"," + std::to_string(child) + "," + std::to_string(parent) + "\n";
    const auto model = [](int id, const std::string& name, const std::string& kind) {
        return "\tModel: " + std::to_string(id) + ", \"Model::" + name + "\", \"" + kind +
               "\" {\n\t\tVersion: 232\n\t}\n";
    };
    return "; FBX 7.4.0 project file\nFBXHeaderExtension:  {\n\tFBXHeaderVersion: 1003\n\tFBXVersion: "
           "7400\n}\n"
           "GlobalSettings:  {\n\tVersion: 1000\n\tProperties70:  {\n\t\tP: \"UpAxis\", \"int\", "
           "\"Integer\", \"\"," +
           std::to_string(words.up_axis) +
           "\n\t\tP: \"UpAxisSign\", \"int\", \"Integer\", \"\",1\n\t\tP: \"UnitScaleFactor\", \"double\", "
           "\"Number\", \"\"," +
           decimal(static_cast<float>(words.unit_cm)) +
           "\n\t}\n}\nObjects:  {\n\tGeometry: 1, \"Geometry::ball\", \"Mesh\" {\n\t\tVertices: *" +
           std::to_string(vertices.size()) + " {\n\t\t\ta: " + joined(vertices) +
           "\n\t\t}\n\t\tPolygonVertexIndex: *" + std::to_string(indices.size()) +
           " {\n\t\t\ta: " + index_list + "\n\t\t}\n\t}\n" + model(2, "ball", "Mesh") +
           model(3, "first", "Null") + model(4, "second", "Null") + "}\nConnections:  {\n" + connected +
           "}\n";
}

} // namespace tests
