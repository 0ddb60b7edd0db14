// WriteFields: the visitor that writes a struct of the job as a JSON object, every default included.
//
// What is not set (a camera left to be framed, a crop) is left out. Transforms are written as `matrix`.
#pragma once

#include "api/fields/ranges.h"
#include "api/fields/texture_fields.h"
#include "api/job_request.h"
#include "api/json/json.h"
#include "api/words/word_table.h"
#include "renderer/description/layers.h"
#include "renderer/description/texture.h"

#include <concepts>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace api {

class WriteFields {
public:
    // `scene`: gives names to the indices of meshes, images and materials.
    WriteFields(Json& out, const renderer::SceneDescription& scene);

    void number(const char* name, double value, const Range&, const char*) { out_[name] = value; }
    void number(const char* name, const std::optional<double>& value, const Range&, const char*)
    {
        if (value) out_[name] = *value;
    }
    template <std::integral T>
    void integer(const char* name, T value, const WholeRange&, const char*)
    {
        out_[name] = value;
    }
    template <std::integral T>
    void integer(const char* name, const std::optional<T>& value, const WholeRange&, const char*)
    {
        if (value) out_[name] = *value;
    }
    void boolean(const char* name, bool value, const char*) { out_[name] = value; }
    template <typename E>
    void word(const char* name, E value, const char*)
    {
        out_[name] = name_of(words_for<E>(), static_cast<int>(value));
    }
    template <typename E>
    void word(const char* name, const std::optional<E>& value, const char* doc)
    {
        if (value) word(name, *value, doc);
    }
    void point(const char* name, const renderer::Vec3d& value, const char*);
    void direction(const char* name, const renderer::Vec3d& value, const char* doc)
    {
        point(name, value, doc);
    }
    void color(const char* name, const renderer::Rgb& value, const Range&, const char*);
    void
    color(const char* name, const std::optional<renderer::Rgb>& value, const Range& range, const char* doc)
    {
        if (value) color(name, *value, range, doc);
    }
    void textured_color(const char* name,
                        const renderer::TexturedColor& value,
                        const Range& range,
                        const char* doc)
    {
        if (value.texture)
            out_[name] = written(*value.texture);
        else
            color(name, value.value, range, doc);
    }
    void textured_number(const char* name,
                         const renderer::TexturedNumber& value,
                         const Range& range,
                         const char* doc)
    {
        if (value.texture)
            out_[name] = written(*value.texture);
        else
            number(name, value.value, range, doc);
    }
    template <typename... D>
    void extents(const char* name, const char*, const D&... sizes)
    {
        out_[name] = Json::array({sizes...});
    }

    template <typename T>
    void object(const char* name, const T& value, const char*)
    {
        out_[name] = written(value);
    }
    template <typename T>
    void object(const char* name, const std::optional<T>& value, const char*)
    {
        if (value) out_[name] = written(*value);
    }
    template <typename Walk>
    void group(const char* name, const char*, const Walk& walk)
    {
        Json json = Json::object();
        WriteFields child(json, scene_);
        walk(child);
        out_[name] = std::move(json);
    }
    template <typename V>
    void kinds(const char* name, const std::optional<V>& value, const char*)
    {
        if (value) out_[name] = written(*value);
    }
    template <typename T>
    void list(const char* name, const std::vector<T>& values, const char*, const char*)
    {
        Json items = Json::array();
        for (const T& value : values)
            items.push_back(written(value));
        out_[name] = std::move(items);
    }
    void table(const char* name, const std::vector<renderer::NamedMaterial>& materials, const char*);

    void coefficients(const char* name, const std::vector<double>& values, const Range&, const char*)
    {
        if (!values.empty()) out_[name] = values;
    }
    void preset(const char* name, const renderer::AtmosphereDescription& atmosphere, const char* doc)
    {
        word(name, atmosphere.preset, doc);
    }

    void unbuilt(std::initializer_list<const char*>, const char*) {}
    void needs(std::initializer_list<const char*>) {}
    void exclude(const char*, const char*, const char*) {}

    template <typename Walk>
    void only_when(bool holds, std::initializer_list<const char*>, const char*, const Walk& walk)
    {
        if (holds) walk();
    }

    void aim(const renderer::CameraDescription& camera);
    void sun_angles(const renderer::Vec3d&) {} // written as a direction
    void geometry(const renderer::Shape& shape);
    void image_of(std::uint32_t image) { out_["image"] = scene_.images.at(image).name; }
    void material_of(const std::optional<std::uint32_t>& material);
    void metal_of(const std::variant<renderer::Metal, renderer::ComplexIor>& ior);
    void placement(const renderer::Affine3& world_from_object);
    void files(const std::map<std::string, std::string>& files) { out_["files"] = files; }
    void labels(const std::map<std::string, std::string>& labels) { out_["labels"] = labels; }
    void fail_on(const std::vector<std::string>& words) { out_["fail_on"] = words; }
    void layers(renderer::LayerSet layers)
    {
        Json& names = out_["layers"] = Json::array();
        for (const renderer::LayerEntry& entry : renderer::kLayers)
            if (layers.has(entry.layer)) names.push_back(entry.name);
    }

private:
    template <typename T>
    [[nodiscard]] Json written(const T& value) const
    {
        Json json = Json::object();
        WriteFields child(json, scene_);
        fields(child, value);
        return json;
    }
    template <typename... Ts>
    [[nodiscard]] Json written(const std::variant<Ts...>& value) const
    {
        Json json = std::visit([this](const auto& alternative) { return this->written(alternative); }, value);
        json["type"] = name_of(words_for<std::variant<Ts...>>(), static_cast<int>(value.index()));
        return json;
    }

    Json& out_;
    const renderer::SceneDescription& scene_;
};

} // namespace api
