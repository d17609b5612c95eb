//! Clocks: 168 MHz from a crystal of 8 MHz, on all chips of this board.

use embassy_stm32::pac;
use embassy_stm32::rcc::{
    AHBPrescaler, APBPrescaler, Hse, HseMode, Pll, PllMul, PllPDiv, PllPreDiv, PllQDiv, PllSource,
    Sysclk,
};
use embassy_stm32::time::Hertz;

/// Clock of the core, Hz.
pub const CORE_HZ: u32 = 168_000_000;
/// Clock of the timers on APB1 (TIM2 to TIM5, TIM12), Hz.
pub const TIMER_HZ: u32 = 84_000_000;
/// Clock of the timers on APB2 (TIM1, TIM8), Hz.
pub const FAST_TIMER_HZ: u32 = 168_000_000;
/// Clock of the peripherals on APB2 (USART1, USART6, SPI1), Hz.
pub const APB2_HZ: u32 = 84_000_000;

/// Starts the clocks and embassy's time; to be called once, first of all.
pub fn start() {
    let mut config = embassy_stm32::Config::default();
    let rcc = &mut config.rcc;
    rcc.hsi = false;
    rcc.hse = Some(Hse {
        freq: Hertz(8_000_000),
        mode: HseMode::Oscillator,
    });
    rcc.pll_src = PllSource::HSE;
    rcc.pll = Some(Pll {
        prediv: PllPreDiv::DIV4,
        mul: PllMul::MUL168,
        divp: Some(PllPDiv::DIV2),
        divq: Some(PllQDiv::DIV7),
        divr: None,
    });
    rcc.ahb_pre = AHBPrescaler::DIV1;
    rcc.apb1_pre = APBPrescaler::DIV4;
    rcc.apb2_pre = APBPrescaler::DIV2;
    rcc.sys = Sysclk::PLL1_P;
    // The singletons are not used: the peripherals of this board work together by hardware triggers, which the drivers of
    // the HAL do not know. Each has its own file here.
    let _ = embassy_stm32::init(config);
    enable_peripherals();
}

fn enable_peripherals() {
    let rcc = pac::RCC;
    rcc.ahb1enr().modify(|w| {
        w.set_gpioaen(true);
        w.set_gpioben(true);
        w.set_gpiocen(true);
        w.set_dma1en(true);
        w.set_dma2en(true);
    });
    rcc.apb1enr().modify(|w| {
        w.set_tim2en(true);
        w.set_tim3en(true);
        w.set_tim4en(true);
        w.set_tim5en(true);
    });
    rcc.apb2enr().modify(|w| {
        w.set_tim1en(true);
        w.set_tim8en(true);
        w.set_usart1en(true);
        w.set_usart6en(true);
        w.set_adc1en(true);
        w.set_spi1en(true);
        w.set_syscfgen(true);
    });
    // A peripheral answers two clocks after its own is on: reading back waits for that.
    let _ = rcc.apb2enr().read();
}
