use racer::lane::*;
use racer::nn::gemm::*;
use racer::nn::mlp::*;
use racer::nn::*;
use std::time::*;
struct K;
impl Kernel for K {
    type Output = ();
    #[inline(always)]
    fn run<L: Lane32>(self) {
        use racer::nn::aligned::Aligned;
        let mk = |v: f32, n: usize| {
            let mut a = Aligned::<f32>::zeros(n);
            a.fill(v);
            a
        };
        let w = mk(0.01, 4096);
        let x = mk(0.02, 4096);
        let mut y = mk(0.0, 4096);
        let b = vec![0.1f32; 64];
        let t = |name: &str, flop: f64, f: &mut dyn FnMut()| {
            let mut dt = 1e9f64;
            for _ in 0..200 {
                let n = 100;
                let s = Instant::now();
                for _ in 0..n {
                    f()
                }
                dt = dt.min(s.elapsed().as_secs_f64() / n as f64);
            }
            println!("{name}: {:.2} us {:.1} GF/s", dt * 1e6, flop / dt / 1e9);
        };
        t("fwd 64x64x64", 2.0 * 64.0 * 64.0 * 64.0, &mut || {
            multiply::<L>(64, 64, 64, Broadcast { data: &w, row: 1, column: 64 }, &x, &mut y, Start::Bias(&b))
        });
        t("bwd in 64x64x64", 2.0 * 64.0 * 64.0 * 64.0, &mut || {
            multiply::<L>(64, 64, 64, Broadcast { data: &w, row: 64, column: 1 }, &x, &mut y, Start::Zero)
        });
        t("60 rows", 2.0 * 60.0 * 64.0 * 64.0, &mut || {
            multiply::<L>(60, 64, 64, Broadcast { data: &w, row: 64, column: 1 }, &x, &mut y, Start::Zero)
        });
        t("head 4", 2.0 * 4.0 * 64.0 * 64.0, &mut || {
            multiply::<L>(4, 64, 64, Broadcast { data: &w, row: 1, column: 4 }, &x, &mut y, Start::Zero)
        });
        t("head 1", 2.0 * 1.0 * 64.0 * 64.0, &mut || {
            multiply::<L>(1, 64, 64, Broadcast { data: &w, row: 1, column: 1 }, &x, &mut y, Start::Zero)
        });
        t("transpose", 0.0, &mut || transpose::<L>(64, 64, &x, &mut y));
        t("tanh", 0.0, &mut || {
            L::vectorize(
                #[inline(always)]
                || {
                    for v in y.chunks_exact_mut(16) {
                        L::from_slice(v).tanh().write(v)
                    }
                },
            )
        });
        let mut net = Network::<f32>::zeros(41);
        net.parameters.iter_mut().enumerate().for_each(|(i, p)| *p = (i % 7) as f32 * 0.01);
        let mut h = Hidden::default();
        let mut sc = Backward::default();
        let mut g = net.parameters.clone();
        let obs = mk(0.1, 41 * 64);
        let mut o = mk(0.1, 256);
        let f = 2.0 * 64.0 * (41.0 * 64.0 + 4096.0 + 256.0);
        t("forward", f, &mut || forward::<L>(&net.actor, &net.parameters, &obs, &mut h, &mut o));
        t("backward", f + 2.0 * 64.0 * (4096.0 + 256.0), &mut || {
            backward::<L>(&net.actor, &net.parameters, &obs, &h, &o, &mut sc, &mut g)
        });
    }
}
fn main() {
    dispatch(Level::best(), K);
    let p = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    println!("peak {:.1}", p.install(|| racer::peak::flops_per_s(Level::best(), Duration::from_millis(300))) / 1e9);
}
