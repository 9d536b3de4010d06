// Callbacks end Embree's builder by an exception, which Embree catches at its C interface. It ignores the result of its
// own progress callback (3.13, for BVHs outside of scenes).
extern "C" void scene_cancel_builder();

namespace {
struct cancelled {};
} // namespace

void scene_cancel_builder() {
  throw cancelled();
}
