//! Renders examples without a window, where there is a graphics driver; one of software will do.

use std::{path::Path, sync::mpsc, time::Duration};

use bevy::{
    asset::RenderAssetUsages,
    camera::RenderTarget,
    prelude::*,
    render::{
        RenderPlugin,
        pipelined_rendering::PipelinedRenderingPlugin,
        render_resource::{Extent3d, TextureDimension, TextureFormat, TextureUsages},
        view::screenshot::{Screenshot, ScreenshotCaptured},
    },
    tasks::block_on,
    time::TimeUpdateStrategy,
    window::ExitCondition,
    winit::WinitPlugin,
};

const SIZE: (u32, u32) = (1280, 720);

/// An example that is drawn to an image.
pub struct Studio {
    pub app: App,
    target: Handle<Image>,
}

impl Studio {
    /// The example after its first frame; `None` without a driver.
    pub fn new(example: fn(&mut App)) -> Option<Self> {
        let instance = wgpu::Instance::default();
        if block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default())).is_err() {
            eprintln!("there is no graphics driver: nothing is drawn");
            return None;
        }
        let mut app = App::new();
        let window =
            WindowPlugin { primary_window: None, exit_condition: ExitCondition::DontExit, ..default() };
        let render = RenderPlugin { synchronous_pipeline_compilation: true, ..default() };
        app.add_plugins(
            DefaultPlugins
                .set(window)
                .set(render)
                .disable::<WinitPlugin>()
                .disable::<PipelinedRenderingPlugin>(),
        )
        .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs(1) / 64))
        .add_plugins(example);
        app.finish();
        app.cleanup();
        app.update();
        let target = redirect(&mut app);
        Some(Self { app, target })
    }

    /// Takes a number of frames of 1/64 s.
    pub fn frames(&mut self, count: usize) {
        (0..count).for_each(|_| self.app.update());
    }

    /// The next frame.
    pub fn capture(&mut self) -> Image {
        let (send, received) = mpsc::channel();
        self.app.world_mut().spawn(Screenshot::image(self.target.clone())).observe(
            move |captured: On<ScreenshotCaptured>| {
                _ = send.send(captured.image.clone());
            },
        );
        for _ in 0..50 {
            self.app.update();
            if let Ok(image) = received.try_recv() {
                return image;
            }
        }
        panic!("no frame was captured");
    }
}

/// Has the camera draw to an image.
fn redirect(app: &mut App) -> Handle<Image> {
    let extent = Extent3d { width: SIZE.0, height: SIZE.1, depth_or_array_layers: 1 };
    let (format, usage) = (TextureFormat::Rgba8UnormSrgb, RenderAssetUsages::RENDER_WORLD);
    let mut image = Image::new_uninit(extent, TextureDimension::D2, format, usage);
    image.texture_descriptor.usage |= TextureUsages::RENDER_ATTACHMENT;
    let image = app.world_mut().resource_mut::<Assets<Image>>().add(image);
    let mut cameras = app.world_mut().query_filtered::<Entity, With<Camera>>();
    let camera = cameras.single(app.world()).expect("an example has one camera");
    app.world_mut().entity_mut(camera).insert(RenderTarget::from(image.clone()));
    image
}

/// Writes a picture for the docs if the folder is asked for.
pub fn keep(image: &Image, name: &str) {
    if let Some(folder) = std::env::var_os("AVIAN_PICTURES") {
        // Tests run in the folder of their package.
        let path = Path::new("../..").join(folder).join(name);
        image.clone().try_into_dynamic().expect("a picture").to_rgb8().save(path).expect("the folder exists");
    }
}

/// The number of pixels of a color.
pub fn count(image: &Image, is_it: impl Fn([u8; 3]) -> bool) -> usize {
    let pixels = image.data.as_ref().expect("a captured image has data").chunks_exact(4);
    pixels.filter(|p| is_it([p[0], p[1], p[2]])).count()
}
