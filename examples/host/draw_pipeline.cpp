#include "draw_pipeline.h"

vk::raii::Pipeline makeDrawPipeline(const Vulkan& vulkan, const DrawPipeline& desc)
{
    const vk::raii::ShaderModule vertex = vulkan.shader(desc.vertex);
    const vk::raii::ShaderModule fragment = desc.fragment.empty() ? vk::raii::ShaderModule(nullptr) : vulkan.shader(desc.fragment);
    const vk::PipelineShaderStageCreateInfo stages[] = {
        {.stage = vk::ShaderStageFlagBits::eVertex, .module = *vertex, .pName = "main"},
        {.stage = vk::ShaderStageFlagBits::eFragment, .module = *fragment, .pName = "main"}};
    const vk::PipelineInputAssemblyStateCreateInfo assembly{.topology = vk::PrimitiveTopology::eTriangleList};
    const vk::PipelineViewportStateCreateInfo viewport{.viewportCount = 1, .scissorCount = 1};
    const vk::PipelineRasterizationStateCreateInfo raster{.cullMode = vk::CullModeFlagBits::eNone, .lineWidth = 1.0f};
    const vk::PipelineMultisampleStateCreateInfo samples{.rasterizationSamples = vk::SampleCountFlagBits::e1};
    const vk::PipelineDepthStencilStateCreateInfo depth{.depthTestEnable = true, .depthWriteEnable = true, .depthCompareOp = desc.nearer};
    using Channel = vk::ColorComponentFlagBits;
    const std::vector<vk::PipelineColorBlendAttachmentState> blends(
        desc.colors.size(), {.colorWriteMask = Channel::eR | Channel::eG | Channel::eB | Channel::eA});
    const vk::PipelineColorBlendStateCreateInfo blend{.attachmentCount = uint32_t(blends.size()), .pAttachments = blends.data()};
    constexpr vk::DynamicState states[] = {vk::DynamicState::eViewport, vk::DynamicState::eScissor};
    const vk::PipelineDynamicStateCreateInfo dynamic{.dynamicStateCount = 2, .pDynamicStates = states};
    const vk::PipelineRenderingCreateInfo rendering{.colorAttachmentCount = uint32_t(desc.colors.size()),
                                                    .pColorAttachmentFormats = desc.colors.data(),
                                                    .depthAttachmentFormat = vk::Format::eD32Sfloat};
    return vk::raii::Pipeline(vulkan.device, nullptr,
                              vk::GraphicsPipelineCreateInfo{.pNext = &rendering,
                                                             .stageCount = desc.fragment.empty() ? 1u : 2u,
                                                             .pStages = stages,
                                                             .pVertexInputState = &desc.input,
                                                             .pInputAssemblyState = &assembly,
                                                             .pViewportState = &viewport,
                                                             .pRasterizationState = &raster,
                                                             .pMultisampleState = &samples,
                                                             .pDepthStencilState = &depth,
                                                             .pColorBlendState = &blend,
                                                             .pDynamicState = &dynamic,
                                                             .layout = desc.layout});
}

void beginDrawing(vk::CommandBuffer cmd, std::span<const Image* const> colors, const Image& depth, float farDepth)
{
    std::vector<vk::RenderingAttachmentInfo> targets;
    for (const Image* color : colors)
        targets.push_back({.imageView = *color->view,
                           .imageLayout = vk::ImageLayout::eColorAttachmentOptimal,
                           .loadOp = vk::AttachmentLoadOp::eClear,
                           .storeOp = vk::AttachmentStoreOp::eStore});
    vk::RenderingAttachmentInfo depthTarget{.imageView = *depth.view,
                                            .imageLayout = vk::ImageLayout::eDepthAttachmentOptimal,
                                            .loadOp = vk::AttachmentLoadOp::eClear,
                                            .storeOp = vk::AttachmentStoreOp::eStore};
    depthTarget.clearValue.depthStencil.depth = farDepth;
    const vk::Rect2D all{{0, 0}, depth.size};
    cmd.beginRendering({.renderArea = all,
                        .layerCount = 1,
                        .colorAttachmentCount = uint32_t(targets.size()),
                        .pColorAttachments = targets.data(),
                        .pDepthAttachment = &depthTarget});
    cmd.setViewport(0, vk::Viewport{0.0f, 0.0f, float(depth.size.width), float(depth.size.height), 0.0f, 1.0f});
    cmd.setScissor(0, all);
}
