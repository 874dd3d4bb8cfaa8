//! Script, renderer and encoder work at the same time, in order, and no scene is prepared long before its turn.

use super::*;
use gpu_trace::animation::{Batch, BatchOutput, Painter, run_batch};
use gpu_trace::cpu::CpuRenderer;
use gpu_trace::flatten::{FlattenCache, SceneBuffers};
use gpu_trace::render::{RenderOptions, Rendered, Unattended, render};
use gpu_trace::scene::Scene;
use gpu_trace::script::ScriptOptions;
use gpu_trace::{Error, Result};
use std::sync::{Arc, Condvar, Mutex};
use std::time::Duration;

const LAST: u32 = 6;
const PREPARE: usize = 0;
const PAINT: usize = 1;
const ENCODE: usize = 2;

/// The latest frame that each stage has begun.
#[derive(Default)]
struct Diary {
    begun: Mutex<[u32; 3]>,
    news: Condvar,
}

impl Diary {
    fn begin(&self, stage: usize, frame: u32) -> [u32; 3] {
        let mut begun = self.begun.lock().expect("no panic before");
        begun[stage] = begun[stage].max(frame);
        self.news.notify_all();
        *begun
    }

    /// Holds a stage up until another has begun a frame; an error if that one waits for the first to go on.
    fn wait_for(&self, stage: usize, frame: u32) -> Result<()> {
        let begun = self.begun.lock().expect("no panic before");
        let limit = Duration::from_secs(20);
        let waited = self.news.wait_timeout_while(begun, limit, |begun| begun[stage] < frame).expect("no panic before");
        if waited.1.timed_out() {
            Err(Error::Scene(format!("stage {stage} did not begin frame {frame}")))
        } else {
            Ok(())
        }
    }
}

struct Waiting<'a>(&'a Diary, CpuRenderer);

impl Painter for Waiting<'_> {
    fn paint(&mut self, frame: u32, _: &Scene, buffers: Arc<SceneBuffers>) -> Result<Rendered> {
        self.0.begin(PAINT, frame);
        // Rendering of frame n does not end before frame n+1 is being prepared.
        self.0.wait_for(PREPARE, (frame + 1).min(LAST))?;
        let options = RenderOptions::whole(&buffers);
        render(buffers, &mut self.1, &options, &mut Unattended)
    }

    fn is_stopped(&self, _: bool) -> bool {
        false
    }
}

struct Encoder<'a>(&'a Diary, Vec<u32>);

impl BatchOutput for Encoder<'_> {
    fn picture(&mut self, frame: u32, _: &Scene, _: Rendered) -> Result<()> {
        self.0.begin(ENCODE, frame);
        self.1.push(frame);
        // Nor does encoding before frame n+1 is being rendered.
        self.0.wait_for(PAINT, (frame + 1).min(LAST))
    }

    fn frame_ended(&mut self, frame: u32, outcome: &Result<()>) {
        assert!(outcome.is_ok(), "frame {frame}: {outcome:?}");
    }
}

#[test]
fn stages_overlap_in_order_and_hold_few_scenes() {
    for jobs in [1, 3] {
        let folder = folder(&swing(""));
        let script = folder.path().join("scene.lua");
        let frames: Vec<u32> = (1..=LAST).collect();
        let cache = FlattenCache::new(2);
        let batch = Batch {
            script: &script,
            frames: &frames,
            options: ScriptOptions { frames: LAST, ..ScriptOptions::default() },
            jobs,
            keep_going: false,
            cache: &cache,
        };
        let diary = Diary::default();
        let prepare = |frame: u32, _: u32, _: &mut Scene| {
            let [_, painted, encoded] = diary.begin(PREPARE, frame);
            // Each thread has one frame in hand; the renderer may have taken one more that it has not begun.
            assert!(frame <= painted + 1 + jobs as u32, "frame {frame} is prepared while {painted} is rendered");
            // The renderer goes on when the encoder has taken the frame before, begun or not.
            assert!(painted <= encoded + 2, "frame {painted} is rendered while {encoded} is encoded");
            Ok(())
        };
        let mut encoder = Encoder(&diary, Vec::new());
        let outcome = run_batch(&batch, &prepare, &mut Waiting(&diary, CpuRenderer::new()), &mut encoder);
        assert!(outcome.is_ok(), "{jobs} jobs: {outcome:?}");
        assert_eq!(encoder.1, frames, "{jobs} jobs");
    }
}
