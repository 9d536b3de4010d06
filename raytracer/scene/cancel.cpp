// How a callback ends Embree's builder: by an exception, which Embree catches where its C interface begins. What its
// own progress callback returns it does not look at (3.13, BVHs that are not of a scene).
extern "C" void scene_cancel_builder();

namespace {
struct cancelled {};
} // namespace

void scene_cancel_builder() {
  throw cancelled();
}
