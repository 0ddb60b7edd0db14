#include "renderer/materials/media.h"

namespace renderer {

const GlassMedium* Media::top(BodyId but) const
{
    const GlassMedium* best = nullptr;
    for (std::size_t i = 0; i < count_; ++i)
        if (!(bodies_[i].id == but) && (best == nullptr || bodies_[i].medium.priority >= best->priority))
            best = &bodies_[i].medium;
    return best;
}

Media::Boundary Media::boundary(BodyId body, const GlassMedium& medium, bool from_outside) const
{
    // What would fill the place of the body if it were not there.
    const GlassMedium* const rest = top(body);
    if (rest != nullptr && rest->priority > medium.priority) return {false, 1};
    const float other = rest != nullptr ? rest->ior : 1;
    return {true, from_outside ? medium.ior / other : other / medium.ior};
}

void Media::cross(BodyId body, const GlassMedium& medium, bool from_outside)
{
    if (from_outside) {
        if (count_ < kMost) bodies_[count_++] = {body, medium};
        return;
    }
    for (std::size_t i = count_; i-- > 0;) {
        if (!(bodies_[i].id == body)) continue;
        for (std::size_t j = i + 1; j < count_; ++j)
            bodies_[j - 1] = bodies_[j];
        --count_;
        return;
    }
}

} // namespace renderer
