#include "scene/named_scene.h"

#include <gtest/gtest.h>

namespace sconce
{
namespace
{

TEST(NamedScene, IsABuiltInOneByItsName)
{
    const auto scene = namedScene("hall");
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->name, "hall");
    EXPECT_FALSE(scene->triangles.empty());
}

TEST(NamedScene, NeitherNameNorFileIsSaidWithWhatThereIs)
{
    for (const char* name : {"hal", "hall.obj", "", "hall/"})
    {
        const auto scene = namedScene(name);
        ASSERT_FALSE(scene) << name;
        EXPECT_EQ(scene.error().code, ErrorCode::badInput);
        EXPECT_NE(scene.error().message.find(std::string("'") + name + "'"), std::string::npos) << scene.error().message;
        EXPECT_NE(scene.error().message.find("hall"), std::string::npos) << scene.error().message;
    }
}

TEST(NamedScene, AFileIsOneByItsEndingInAnyCase)
{
    for (const char* name : {"nothing.glb", "nothing.GLTF"})
    {
        const auto scene = namedScene(name);
        ASSERT_FALSE(scene);
        EXPECT_EQ(scene.error().code, ErrorCode::fileError) << scene.error().message;
    }
}

} // namespace
} // namespace sconce
