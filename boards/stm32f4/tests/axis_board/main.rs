#![no_std]
#![no_main]
use board_stm32f4 as _;
#[embedded_test::tests]
mod tests {
    #[test]
    fn one() {
        assert!(board_stm32f4::clocks::CORE_HZ > 1);
    }
}
